// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pursuit::tracker {

/// Whether one object lies behind another, by what its contour makes inside the other: as many
/// events as its motion should when it is in front, few when it is behind. What the other makes
/// inside of it tells as well, since only one of the two can show where they overlap. What was
/// found holds until something else is told. Thread: the tracker's.
class OverlapEvidence {
 public:
    /// So many events should have come from the contour inside the other, and came.
    void add(double expected, double observed) {
        expected_ += expected;
        observed_ += observed;
    }
    /// Of what was counted so much counts on.
    void fade(double kept) {
        expected_ *= kept;
        observed_ *= kept;
    }
    /// Next to nothing was counted of late.
    [[nodiscard]] bool is_faded() const { return expected_ < faded && observed_ < faded; }

    /// Whether it is behind; `other`: of the other's contour inside this one.
    bool decide(const OverlapEvidence& other) {
        const bool is_missing = expected_ > least_expected &&
                                observed_ < hidden_share * expected_ &&
                                other.shows_more_than(front_share);
        // What hardly moves across itself misses little; that the other is seen tells as well.
        const bool other_is_seen =
            other.expected_ > surely_expected && other.shows_more_than(surely_share);
        const bool is_hardly_seen = observed_ < front_share * expected_ + stray_events;
        if (is_missing || (other_is_seen && is_hardly_seen)) {
            is_behind_ = true;
        } else if (expected_ > least_expected && shows_more_than(front_share)) {
            // Where the lines of the one in front pass along those of the other, its events are
            // taken for the other's for a while. That of which more shows stays in front.
            const bool is_less_seen = observed_ * other.expected_ < other.observed_ * expected_;
            if (!(other_is_seen && is_less_seen)) is_behind_ = false;
        }
        return is_behind_;
    }

 private:
    [[nodiscard]] bool shows_more_than(double share) const { return observed_ > share * expected_; }

    static constexpr double least_expected = 20;
    static constexpr double hidden_share = 0.25;
    static constexpr double front_share = 0.4;
    static constexpr double surely_expected = 60;
    static constexpr double surely_share = 0.7;
    static constexpr double stray_events = 5;
    static constexpr double faded = 0.5;  // expected events

    double expected_ = 0;
    double observed_ = 0;
    bool is_behind_ = false;
};

}  // namespace pursuit::tracker
