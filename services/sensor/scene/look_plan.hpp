// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/sensor/scene/active_pixels.hpp"

namespace pursuit::sensor {

/// Which pixels take part in which look. Looks are numbered from 1; an active pixel takes part in
/// those alone that may matter to it. Memory: proportional to the pixels. Threads: one.
class LookPlan {
 public:
    /// No pixel that is near something goes for more looks without one of its own.
    static constexpr std::uint32_t greatest_skip = 63;

    explicit LookPlan(std::size_t pixels) : next_look_(pixels, 0) {}

    /// The active pixels are found anew: from now on they are meant where a pixel is named by its
    /// number `active` among them. Each keeps the look that was planned for it.
    void restart(const std::vector<ActivePixels::Pixel>& active_pixels);

    /// Every pixel has looked just now: none keeps what was planned for it.
    void forget();

    /// The next look begins. The active pixels that take part, each of which then goes to
    /// after_look() or postpone(); valid until the next look.
    const std::vector<std::uint32_t>& begin_look();

    /// The active pixel has looked; it looks again `looks` from now, 1 to greatest_skip.
    void after_look(std::uint32_t active, std::uint32_t index, std::uint32_t looks) {
        next_look_[index] = look_ + looks;
        put(active, next_look_[index]);
    }

    /// The active pixel has not looked; it takes part again `looks` from now, 1 to greatest_skip.
    void postpone(std::uint32_t active, std::uint32_t looks) { put(active, look_ + looks); }

 private:
    void put(std::uint32_t active, std::uint64_t look) {
        plan_[look % plan_.size()].push_back(active);
    }

    std::uint64_t look_ = 0;
    std::vector<std::uint64_t> next_look_;  // by pixel: the look at which it looks again
    // The active pixels, by number, that look next at each of the looks to come, modulo.
    std::array<std::vector<std::uint32_t>, greatest_skip + 1> plan_;
    std::vector<std::uint32_t> looking_;
};

}  // namespace pursuit::sensor
