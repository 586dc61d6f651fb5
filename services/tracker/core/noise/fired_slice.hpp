// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "services/tracker/core/noise/fired_counts.hpp"

namespace pursuit::tracker {

/// What fired in a short time about each pixel of a window, by polarity, less the mean: how much
/// more than noise.
struct FiredSlice {
    /// What a place of the counts holds of its own pixel and of those beside it, across and down.
    static constexpr std::array<float, 3> across_px{0.25F, 0.5F, 0.25F};

    int left = 0;
    int top = 0;
    int side = 0;
    std::vector<std::array<float, 2>> counts;  // OFF, ON
    double mean = 0;                           // of one of them

    [[nodiscard]] std::size_t index(int row, int column) const {
        return static_cast<std::size_t>(row * side + column);
    }
    /// With the window of these counts, and nothing in it.
    void begin(const FiredCounts& fired);
    void add(const FiredCounts& fired);
    /// All was added. Events were asked for so far about this place.
    void close(const Eigen::Vector2d& middle_px, double radius_px);
    /// Between pixels, OFF and ON; nothing outside the window.
    [[nodiscard]] std::array<double, 2> at(double x_px, double y_px) const;

 private:
    void take_mean(const Eigen::Vector2d& middle_px, double radius_px);
    void spread();
};

}  // namespace pursuit::tracker
