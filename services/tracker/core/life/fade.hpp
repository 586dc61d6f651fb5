// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pursuit::tracker {

/// What stays of a memory after a time in which nothing came: exp(−t/memory). The times between
/// events are short and whole µs, so they are in a table.
class Fade {
 public:
    explicit Fade(double memory_s) : memory_s_(memory_s) {
        for (std::size_t t_us = 0; t_us < kept_.size(); ++t_us) {
            kept_[t_us] = computed(static_cast<std::int64_t>(t_us));
        }
    }

    [[nodiscard]] double over(std::int64_t t_us) const {
        const auto at = static_cast<std::size_t>(t_us);
        return at < kept_.size() ? kept_[at] : computed(t_us);
    }

 private:
    [[nodiscard]] double computed(std::int64_t t_us) const {
        return std::exp(-(static_cast<double>(t_us) * 1e-6) / memory_s_);
    }

    double memory_s_;
    std::array<double, 1024> kept_{};
};

}  // namespace pursuit::tracker
