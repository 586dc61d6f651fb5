// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/fired_window.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace pursuit::tracker {
namespace {

constexpr int margin_px = 8;  // that the object moves before the window follows

}  // namespace

void FiredWindow::place(const Eigen::Vector2d& middle_px, int reach_px) {
    const int half = reach_px + 2 * margin_px;
    const int left = static_cast<int>(std::lround(middle_px.x())) - half;
    const int top = static_cast<int>(std::lround(middle_px.y())) - half;
    const auto side = static_cast<unsigned>(2 * half + 1);
    if (side == fresh_.side && std::abs(left - fresh_.left) <= margin_px &&
        std::abs(top - fresh_.top) <= margin_px) {
        return;
    }
    for (std::vector<float>& counts : slices_) {
        std::vector<float> moved(std::size_t{side} * side);
        for (unsigned row = 0; row < side; ++row) {
            const auto old_row = static_cast<unsigned>(static_cast<int>(row) + top - fresh_.top);
            if (old_row >= fresh_.side) continue;
            for (unsigned column = 0; column < side; ++column) {
                const auto old =
                    static_cast<unsigned>(static_cast<int>(column) + left - fresh_.left);
                if (old < fresh_.side)
                    moved[row * side + column] = counts[old_row * fresh_.side + old];
            }
        }
        counts = std::move(moved);
    }
    fresh_.left = left;
    fresh_.top = top;
    fresh_.side = side;
    reach_px_ = reach_px;
    fresh_.events.assign(slices_[0].size(), {});
    across_.assign(slices_[0].size(), 0);
}

void FiredWindow::close_slice() {
    if (fresh_.side == 0) return;
    std::rotate(slices_.begin(), slices_.end() - 1, slices_.end());
    // By 1 2 1 across and down: as far as events stray.
    const auto fired = [&](std::size_t i) { return fresh_.events[i][0] + fresh_.events[i][1]; };
    const std::size_t size = fresh_.events.size();
    for (std::size_t i = 1; i + 1 < size; ++i) {
        across_[i] = static_cast<float>(fired(i - 1) + 2 * fired(i) + fired(i + 1));
    }
    std::vector<float>& counts = slices_[0];
    for (std::size_t i = fresh_.side; i + fresh_.side < size; ++i) {
        counts[i] = (across_[i - fresh_.side] + 2 * across_[i] + across_[i + fresh_.side]) / 16;
    }
    fill_up(counts);
    fresh_.clear();
}

// No events come from where they are not asked for, and from beyond the image: as many as elsewhere
// would be, lest places that reach there seem emptier than others.
void FiredWindow::fill_up(std::vector<float>& counts) {
    const auto side = static_cast<int>(fresh_.side);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const auto& fired = fresh_.events[static_cast<std::size_t>(row * side + column)];
            if (fired[0] + fired[1] == 0) continue;
            seen_.include(fresh_.left + column, fresh_.top + row);
        }
    }
    // About the middle all of them were asked for.
    const auto about = static_cast<int>(reach_px_ / std::numbers::sqrt2);
    const int middle = side / 2;
    double sum = 0;
    double pixels = 0;
    const auto is_seen = [&](int row, int column) {
        return seen_.is_inside(fresh_.left + column, fresh_.top + row);
    };
    for (int row = middle - about; row <= middle + about; ++row) {
        for (int column = middle - about; column <= middle + about; ++column) {
            if (!is_seen(row, column)) continue;
            sum += counts[row * side + column];
            ++pixels;
        }
    }
    const auto usual = static_cast<float>(pixels > 0 ? sum / pixels : 0);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            if (!is_seen(row, column)) counts[row * side + column] = usual;
        }
    }
}

}  // namespace pursuit::tracker
