// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "services/tracker/core/geometry/contour.hpp"
#include "services/tracker/core/geometry/outline.hpp"
#include "services/tracker/core/geometry/pose.hpp"

namespace pursuit::tracker {

/// How much of a contour its events come from. Each part of a moving contour makes events as fast
/// as it moves across itself; a pose that fits only a part of what is there leaves other parts
/// without the events that they should make.
class Cover {
 public:
    /// Of nothing: there is nothing to be counted.
    Cover() = default;
    explicit Cover(const Contour& contour);

    void restart();

    /// An event on this piece of the contour.
    void count(std::int32_t piece) {
        ++counted_[sector_of_[static_cast<std::size_t>(piece)]];
        ++events_;
    }
    /// Whether enough were counted for close_window().
    [[nodiscard]] bool is_due() const { return events_ >= window_events; }
    /// Weighs what was counted, under this pose and velocity. Nothing is expected of what the
    /// outline says cannot be seen.
    void close_window(const Outline& outline, const Pose& pose, const Velocity& velocity);

    /// The share of the expected events whose parts of the contour got a quarter or more of theirs,
    /// 0 … 1; over the last few hundred events.
    [[nodiscard]] double share() const { return share_; }

 private:
    static constexpr std::size_t sectors = 20;
    static constexpr int window_events = 50;
    static constexpr int usual_parts = 40;
    static constexpr int most_parts = 1024;

    // By part. (Not in the object itself: that would make a track as large as its contour may be,
    // and many tracks would lie on as many pages of memory.)
    using Numbers = Eigen::ArrayXd;
    struct Vectors {
        Numbers x, y;
    };
    /// The same for a moment: nothing is allocated.
    using MomentaryNumbers = Eigen::Array<double, Eigen::Dynamic, 1, 0, most_parts, 1>;
    struct MomentaryVectors {
        MomentaryNumbers x, y;
    };

    std::vector<std::uint8_t> sector_of_;  // by piece
    std::vector<std::uint8_t> sector_of_part_;
    std::vector<std::int32_t> piece_;  // by part: its first
    Vectors middle_px_;                // model frame
    Vectors along_px_;
    Numbers sideways_px_;  // what it makes however it moves
    std::array<double, sectors> counted_{};
    std::array<double, sectors> expected_{};
    int events_ = 0;
    double share_ = 1;
};

}  // namespace pursuit::tracker
