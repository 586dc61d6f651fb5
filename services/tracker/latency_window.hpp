// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>

#include "services/tracker/latency_histogram.hpp"

namespace pursuit::tracker {

/// The durations of the last 5 to 10 s in which there were any: two histograms that take turns, so
/// that a stall is forgotten and no sample has to be kept. Threads: one.
class LatencyWindow {
 public:
    static constexpr std::int64_t half_ns = 5'000'000'000;

    /// `now_ns`: steady.
    void add(std::int64_t duration_us, std::int64_t now_ns) {
        const auto age_ns = now_ns - begun_ns_;
        if (age_ns >= half_ns) {
            std::swap(newer_, older_);
            newer_.clear();
            if (age_ns >= 2 * half_ns) older_.clear();
            begun_ns_ = now_ns;
        }
        newer_.add(duration_us);
    }

    [[nodiscard]] LatencyHistogram both() const {
        LatencyHistogram sum = older_;
        sum.add(newer_);
        return sum;
    }

    void clear() { *this = {}; }

 private:
    LatencyHistogram older_;
    LatencyHistogram newer_;
    std::int64_t begun_ns_ = 0;  ///< When newer_ was.
};

}  // namespace pursuit::tracker
