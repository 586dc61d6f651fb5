// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/fired_map.hpp"

#include <algorithm>

namespace pursuit::tracker {
namespace {

constexpr std::size_t most_map_cells = 100'000;

}  // namespace

void FiredMap::build(Geometry geometry, std::span<const Event> events) {
    int cell_px = 1;
    const auto cells = [](int length_px, int cell) { return (length_px + cell - 1) / cell; };
    while (static_cast<std::size_t>(cells(geometry.width, cell_px)) *
               static_cast<std::size_t>(cells(geometry.height, cell_px)) >
           most_map_cells) {
        ++cell_px;
    }
    cell_px_ = cell_px;
    columns_ = cells(geometry.width, cell_px);
    rows_ = cells(geometry.height, cell_px);
    distance_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
                     std::uint8_t{farthest});
    for (const Event& event : events) distance_[at(event.x / cell_px, event.y / cell_px)] = 0;

    // Chamfer distance: 3 a step along an axis, 4 a step along a diagonal.
    const auto reach = [&](int column, int row, int from_column, int from_row, int step) {
        if (from_column < 0 || from_row < 0 || from_column >= columns_ || from_row >= rows_) return;
        std::uint8_t& here = distance_[at(column, row)];
        here = static_cast<std::uint8_t>(
            std::min<int>(here, distance_[at(from_column, from_row)] + step));
    };
    for (int row = 0; row < rows_; ++row) {
        for (int column = 0; column < columns_; ++column) {
            reach(column, row, column - 1, row, 3);
            reach(column, row, column - 1, row - 1, 4);
            reach(column, row, column, row - 1, 3);
            reach(column, row, column + 1, row - 1, 4);
        }
    }
    for (int row = rows_ - 1; row >= 0; --row) {
        for (int column = columns_ - 1; column >= 0; --column) {
            reach(column, row, column + 1, row, 3);
            reach(column, row, column + 1, row + 1, 4);
            reach(column, row, column, row + 1, 3);
            reach(column, row, column - 1, row + 1, 4);
        }
    }

    const auto wide = static_cast<std::size_t>(columns_) + 1;
    sums_.assign(wide * (static_cast<std::size_t>(rows_) + 1), {});
    for (int row = 0; row < rows_; ++row) {
        Sums of_row;
        for (int column = 0; column < columns_; ++column) {
            const std::uint32_t d = distance_[at(column, row)];
            of_row.fired += d == 0 ? 1 : 0;
            of_row.distance += d;
            of_row.squared += d * d;
            const std::size_t i =
                (static_cast<std::size_t>(row) + 1) * wide + static_cast<std::size_t>(column) + 1;
            const Sums& above = sums_[i - wide];
            sums_[i] = {above.fired + of_row.fired, above.distance + of_row.distance,
                        above.squared + of_row.squared};
        }
    }
}

FiredMap::Around FiredMap::around(int column, int row, int half_side) const {
    const int left = std::clamp(column - half_side, 0, columns_);
    const int right = std::clamp(column + half_side + 1, 0, columns_);
    const int top = std::clamp(row - half_side, 0, rows_);
    const int bottom = std::clamp(row + half_side + 1, 0, rows_);
    const auto wide = static_cast<std::size_t>(columns_) + 1;
    const auto sums = [&](int x, int y) -> const Sums& {
        return sums_[static_cast<std::size_t>(y) * wide + static_cast<std::size_t>(x)];
    };
    // Differences of sums that wrap are right as long as the square's own sum is below 2^32.
    const auto over = [&](std::uint32_t Sums::*member) {
        return static_cast<double>(sums(right, bottom).*member - sums(left, bottom).*member -
                                   sums(right, top).*member + sums(left, top).*member);
    };
    Around around;
    const double count = std::max((right - left) * (bottom - top), 1);
    around.fired = over(&Sums::fired);
    around.mean = over(&Sums::distance) / count;
    around.variance = std::max(over(&Sums::squared) / count - around.mean * around.mean, 0.0);
    return around;
}

}  // namespace pursuit::tracker
