// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace pursuit::sensor {

/// Times of events, one for each of many places, in 32 bits: half the memory is more than half of
/// the speed here. Exact as long as only times of the last `reach_us` matter: what is older reads
/// as never. Time does not decrease. One thread.
class RecentTimes {
 public:
    /// `reach_us` at most 2^30.
    RecentTimes(std::size_t places, std::int64_t reach_us) : reach_us_(reach_us), times_(places) {}

    /// The time as it is stored, for the present event; more than reach_us. Now and then it moves
    /// all stored times, so it comes before at().
    std::uint32_t now(std::int64_t t_us) {
        if (t_us - base_us_ >= most_us_) move_base(t_us);
        return static_cast<std::uint32_t>(t_us - base_us_);
    }

    /// What was stored there; 0: never, or not within reach.
    std::uint32_t* at(std::size_t place) { return times_.data() + place; }

 private:
    static constexpr std::int64_t most_us_ = 0xffff'ffff;

    void move_base(std::int64_t t_us) {
        const auto base_us = t_us - reach_us_ - 1;
        const auto by_us = begun_ ? base_us - base_us_ : most_us_ + 1;
        for (auto& time_us : times_) {
            time_us = time_us > by_us ? static_cast<std::uint32_t>(time_us - by_us) : 0;
        }
        base_us_ = base_us;
        begun_ = true;
    }

    std::int64_t reach_us_;
    // So far in the past that the first event sets it.
    std::int64_t base_us_ = -(std::int64_t{1} << 62);
    bool begun_ = false;
    std::vector<std::uint32_t> times_;
};

}  // namespace pursuit::sensor
