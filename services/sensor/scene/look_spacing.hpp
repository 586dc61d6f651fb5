// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "services/sensor/scene/active_pixels.hpp"

namespace pursuit::sensor {

/// How many looks a pixel may leave out without an event in between. Threads: any.
class LookSpacing {
 public:
    /// Pixels may be looked at every so many looks, where edges move along themselves.
    static constexpr std::uint32_t greatest_stride = 4;

    /// `max_step_px`: the furthest that an edge moves from look to look. `sigma_px`: as ImageEdges
    /// has it.
    LookSpacing(double max_step_px, double sigma_px)
        : way_sigmas_(static_cast<float>(max_step_px / sigma_px)) {}

    /// How many looks from now the next one may be, 1 to LookPlan::greatest_skip. `room`: as
    /// PixelArray has it. unknown_sigmas: no edge that the sight leaves out is nearer.
    ///
    /// With n edges that move by `way` a look no nearer than d, what the pixel sees changes in k
    /// looks by at most n · contrast · (tail(d - k way) - tail(d)): no event comes before that has
    /// used up the room to the next threshold. Edges beyond the cut count as one of full contrast.
    std::uint32_t looks_without_event(const ActivePixels::Pixel& pixel, const Nearness& nearness,
                                      float room, float unknown_sigmas) const;

 private:
    float way_sigmas_;
};

}  // namespace pursuit::sensor
