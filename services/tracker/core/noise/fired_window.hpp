// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/tracker/core/noise/fired_box.hpp"
#include "services/tracker/core/noise/fired_counts.hpp"

namespace pursuit::tracker {

/// What fired lately about an object: events by pixel of a window that follows it, in slices of
/// time. Thread: the tracker's.
class FiredWindow {
 public:
    static constexpr std::size_t slices = 5;

    /// Nothing was seen yet.
    void restart() {
        fresh_.side = 0;
        seen_ = {};
    }

    void see(std::uint16_t x, std::uint16_t y, std::uint8_t polarity) {
        fresh_.see(x, y, polarity);
    }
    /// What was seen last is not to be counted.
    void forget(std::uint16_t x, std::uint16_t y, std::uint8_t polarity) {
        fresh_.forget(x, y, polarity);
    }
    /// What was seen since the last slice.
    [[nodiscard]] const FiredCounts& fresh() const { return fresh_; }

    /// What was seen since the last slice is the newest now.
    void close_slice();
    /// About this place, image px, and so far to each side; with some px of margin, so that it need
    /// not move with each step.
    void place(const Eigen::Vector2d& middle_px, int reach_px);

    /// How many events came from about each pixel, row by row; slice 0 is the newest. Where none
    /// are asked for, and beyond the image, as many as elsewhere.
    [[nodiscard]] const std::vector<float>& slice(std::size_t i) const { return slices_[i]; }
    /// Of the first pixel, image px.
    [[nodiscard]] int left() const { return fresh_.left; }
    [[nodiscard]] int top() const { return fresh_.top; }
    [[nodiscard]] unsigned side() const { return fresh_.side; }
    /// So far from the object events are asked for whenever one comes.
    [[nodiscard]] int reach_px() const { return reach_px_; }
    /// Where events came from, image px.
    [[nodiscard]] const FiredBox& seen() const { return seen_; }

 private:
    void fill_up(std::vector<float>& counts);

    FiredCounts fresh_;
    FiredBox seen_;
    int reach_px_ = 0;
    std::array<std::vector<float>, slices> slices_;
    std::vector<float> across_;  // while a slice is closed
};

}  // namespace pursuit::tracker
