// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "services/tracker/core/noise/fired_box.hpp"

namespace pursuit::tracker {

/// What fired about an object in the pixels beside its contour. Noise comes from all of them alike,
/// as chance has it; the edges of other things make many events in a few of them.
class FiredBeside {
 public:
    /// Of the contour no farther away than this, px, is what is left out.
    static constexpr int near_px = 3;

    /// Nothing fired in a square window; side: px.
    void begin(unsigned side);
    /// How many events there were about each pixel, row by row: spread by 1 2 1 across and down.
    void add(std::span<const float> counts);
    /// The contour passed this place of the window (column, row). After all was added.
    void leave_out(const Eigen::Vector2d& place_px);

    /// The variance of what the pixels counted over that of noise which brings as much: about 1 in
    /// noise alone, and where too few are left to tell. Of the pixels within radius_px of a place
    /// that are not beyond where events come from, both in the window.
    [[nodiscard]] double unevenness(const Eigen::Vector2d& middle_px, double radius_px,
                                    const FiredBox& seen) const;

 private:
    int side_ = 0;
    std::vector<float> counts_;  // < 0 where it is of the contour
};

}  // namespace pursuit::tracker
