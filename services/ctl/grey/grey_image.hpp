// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/common/event.hpp"
#include "services/common/result.hpp"

namespace pursuit::ctl {

/// The grey-level image that ATIS exposure measurements make (Posch, Matolin & Wohlgenannt, IEEE
/// JSSC 46 (2011)): a pixel integrates light from one threshold to the next, and its intensity is
/// the inverse of the time that this takes. A crossing of threshold 0 begins a measurement, or
/// begins it anew; the next of threshold 1 ends it. Each pixel keeps its last one.
class GreyImage {
 public:
    explicit GreyImage(Geometry geometry);

    Geometry geometry() const { return geometry_; }

    /// Takes the next crossings, in order of time; those outside the geometry are left out.
    void take(std::span<const Event> exposures);

    /// What was measured at each pixel, µs, at y·width + x; 0: nothing yet.
    const std::vector<std::uint32_t>& integration_us() const { return integration_us_; }

    std::size_t measured_pixels() const;

    /// Levels 1 … 255 on a scale of the logarithm of intensity, from its 2nd percentile to its
    /// 98th, as such scenes span more than a screen can; 0 where nothing is measured.
    std::vector<std::uint8_t> levels() const;

 private:
    Geometry geometry_;
    std::vector<std::int64_t> begun_us_;  // −1: none is open
    std::vector<std::uint32_t> integration_us_;
};

/// The levels as a PNG of 8 bits a pixel.
Result<std::vector<std::uint8_t>> grey_png(const GreyImage& image);

}  // namespace pursuit::ctl
