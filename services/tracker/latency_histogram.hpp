// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace pursuit::tracker {

/// Counts durations in buckets whose width is 1/16 of their power of two, so a percentile is at
/// most 6.25 % above the true one. Bounded: 0 µs … 2^40 µs, longer ones in the last bucket.
class LatencyHistogram {
 public:
    /// A negative duration (a clock that was set back) counts as 0.
    void add(std::int64_t duration_us) {
        const auto us = static_cast<std::uint64_t>(std::max<std::int64_t>(duration_us, 0));
        ++buckets_[bucket_of(us)];
        ++samples_;
        max_us_ = std::max(max_us_, us);
    }

    /// Those of another.
    void add(const LatencyHistogram& other) {
        for (std::size_t i = 0; i < buckets_.size(); ++i) buckets_[i] += other.buckets_[i];
        samples_ += other.samples_;
        max_us_ = std::max(max_us_, other.max_us_);
    }

    [[nodiscard]] std::uint64_t samples() const { return samples_; }
    [[nodiscard]] double max_us() const { return static_cast<double>(max_us_); }

    /// The upper edge of the bucket that holds the given share (0 … 1) of the samples, at most the
    /// largest sample; 0 without samples.
    [[nodiscard]] double percentile_us(double share) const {
        if (samples_ == 0) return 0;
        const auto wanted = static_cast<std::uint64_t>(
            std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(samples_)));
        std::uint64_t seen = 0;
        for (std::size_t bucket = 0; bucket < buckets_.size(); ++bucket) {
            seen += buckets_[bucket];
            if (seen >= wanted && seen > 0) {
                return static_cast<double>(std::min(upper_edge_us(bucket), max_us_));
            }
        }
        return max_us();
    }

    void clear() { *this = {}; }

 private:
    static constexpr unsigned steps = 16;
    static constexpr unsigned powers = 37;  // from 2^4 up; below it each µs has its own bucket

    static std::size_t bucket_of(std::uint64_t us) {
        if (us < steps) return us;
        const auto power = static_cast<unsigned>(std::bit_width(us)) - 5;  // us >> power: 16 … 31
        return std::min<std::size_t>(steps * (power + 1) + ((us >> power) - steps),
                                     steps * powers - 1);
    }
    static std::uint64_t upper_edge_us(std::size_t bucket) {
        if (bucket < steps) return bucket;
        const std::size_t power = bucket / steps - 1;
        return ((bucket % steps + steps + 1) << power) - 1;
    }

    std::array<std::uint64_t, steps * powers> buckets_{};
    std::uint64_t samples_ = 0;
    std::uint64_t max_us_ = 0;
};

}  // namespace pursuit::tracker
