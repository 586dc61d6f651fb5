// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/fired_slice.hpp"

#include <algorithm>

namespace pursuit::tracker {

void FiredSlice::begin(const FiredCounts& fired) {
    left = fired.left;
    top = fired.top;
    side = static_cast<int>(fired.side);
    counts.assign(fired.events.size(), {});
}

void FiredSlice::add(const FiredCounts& fired) {
    const auto fired_side = static_cast<int>(fired.side);
    for (int row = 0; row < fired_side; ++row) {
        const int to_row = row + fired.top - top;
        if (to_row < 0 || to_row >= side) continue;
        for (int column = 0; column < fired_side; ++column) {
            const int to_column = column + fired.left - left;
            if (to_column < 0 || to_column >= side) continue;
            const auto& from = fired.events[static_cast<std::size_t>(row * fired_side + column)];
            auto& to = counts[index(to_row, to_column)];
            for (std::size_t polarity = 0; polarity < 2; ++polarity) to[polarity] += from[polarity];
        }
    }
}

void FiredSlice::close(const Eigen::Vector2d& middle_px, double radius_px) {
    take_mean(middle_px, radius_px);
    spread();
}

// No events come from where they are not asked for, and from beyond the image: that tells nothing.
void FiredSlice::take_mean(const Eigen::Vector2d& middle_px, double radius_px) {
    int first_row = side, last_row = -1, first_column = side, last_column = -1;
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const auto& fired = counts[index(row, column)];
            if (fired[0] + fired[1] == 0) continue;
            first_row = std::min(first_row, row);
            last_row = std::max(last_row, row);
            first_column = std::min(first_column, column);
            last_column = std::max(last_column, column);
        }
    }
    const auto is_seen = [&](int row, int column) {
        const double dx = column + left - middle_px.x();
        const double dy = row + top - middle_px.y();
        return row > first_row && row < last_row && column > first_column && column < last_column &&
               dx * dx + dy * dy < radius_px * radius_px;
    };
    double sum = 0;
    double pixels = 0;
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            if (!is_seen(row, column)) continue;
            const auto& fired = counts[index(row, column)];
            sum += fired[0] + fired[1];
            ++pixels;
        }
    }
    mean = pixels > 0 ? sum / pixels / 2 : 0;
    const auto usual = static_cast<float>(mean);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            auto& fired = counts[index(row, column)];
            if (is_seen(row, column)) {
                fired = {fired[0] - usual, fired[1] - usual};
            } else {
                fired = {};
            }
        }
    }
}

// By 1 2 1 across and down: as far as events stray.
void FiredSlice::spread() {
    std::vector<std::array<float, 2>> across(counts.size());
    const auto stride = static_cast<std::size_t>(side);
    for (std::size_t polarity = 0; polarity < 2; ++polarity) {
        const auto sum = [&](const auto& of, std::size_t i, std::size_t step) {
            return across_px[0] * of[i - step][polarity] + across_px[1] * of[i][polarity] +
                   across_px[2] * of[i + step][polarity];
        };
        for (std::size_t i = 1; i + 1 < counts.size(); ++i) {
            across[i][polarity] = sum(counts, i, 1);
        }
        for (std::size_t i = stride; i + stride < counts.size(); ++i) {
            counts[i][polarity] = sum(across, i, stride);
        }
    }
}

std::array<double, 2> FiredSlice::at(double x_px, double y_px) const {
    const double x = x_px - left;
    const double y = y_px - top;
    if (!(x >= 0 && y >= 0 && x < side - 1 && y < side - 1)) return {};
    const auto column = static_cast<int>(x);
    const auto row = static_cast<int>(y);
    const double right = x - column;
    const double down = y - row;
    const std::array<float, 2>* upper = &counts[index(row, column)];
    const std::array<float, 2>* lower = upper + side;
    std::array<double, 2> value{};
    for (std::size_t i = 0; i < 2; ++i) {
        value[i] = (1 - down) * ((1 - right) * upper[0][i] + right * upper[1][i]) +
                   down * ((1 - right) * lower[0][i] + right * lower[1][i]);
    }
    return value;
}

}  // namespace pursuit::tracker
