// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/search/fired_map.hpp"

#include <algorithm>

namespace pursuit::tracker {
namespace {

constexpr std::size_t most_map_cells = 100'000;
constexpr int along_step = 3;
constexpr int aslant_step = 4;

int cells(int length_px, int cell_px) { return (length_px + cell_px - 1) / cell_px; }

}  // namespace

int FiredMap::cell_px_of(Geometry geometry) {
    int cell_px = 1;
    while (static_cast<std::size_t>(cells(geometry.width, cell_px)) *
               static_cast<std::size_t>(cells(geometry.height, cell_px)) >
           most_map_cells) {
        ++cell_px;
    }
    return cell_px;
}

void FiredMap::build(Geometry geometry, std::span<const Event> events) {
    const int cell_px = cell_px_of(geometry);
    cell_px_ = cell_px;
    columns_ = cells(geometry.width, cell_px);
    rows_ = cells(geometry.height, cell_px);
    int right = 0;
    int bottom = 0;
    left_ = columns_;
    top_ = rows_;
    for (const Event& event : events) {
        left_ = std::min(left_, event.x / cell_px);
        right = std::max(right, event.x / cell_px + 1);
        top_ = std::min(top_, event.y / cell_px);
        bottom = std::max(bottom, event.y / cell_px + 1);
    }
    constexpr int around = farthest / along_step;
    left_ = std::max(left_ - around, 0);
    top_ = std::max(top_ - around, 0);
    width_ = std::max(std::min(right + around, columns_) - left_, 0);
    height_ = std::max(std::min(bottom + around, rows_) - top_, 0);
    distance_.assign(static_cast<std::size_t>(width_ + 2) * static_cast<std::size_t>(height_ + 2),
                     std::uint8_t{farthest});
    for (const Event& event : events) {
        distance_[at(event.x / cell_px - left_, event.y / cell_px - top_)] = 0;
    }
    spread();
    add_up();
}

// Chamfer distance: 3 a step along an axis, 4 a step along a diagonal.
void FiredMap::spread() {
    const auto from_row = [&](std::uint8_t* here, const std::uint8_t* other) {
        for (int x = 0; x < width_; ++x) {
            const int aslant = std::min(other[x - 1], other[x + 1]) + aslant_step;
            const int along = other[x] + along_step;
            here[x] = static_cast<std::uint8_t>(std::min({int{here[x]}, aslant, along}));
        }
    };
    const auto from_cell = [](std::uint8_t* here, std::uint8_t other) {
        *here = static_cast<std::uint8_t>(std::min(int{*here}, other + along_step));
    };
    for (int y = 0; y < height_; ++y) {
        std::uint8_t* here = &distance_[at(0, y)];
        from_row(here, &distance_[at(0, y - 1)]);
        for (int x = 0; x < width_; ++x) from_cell(here + x, here[x - 1]);
    }
    for (int y = height_ - 1; y >= 0; --y) {
        std::uint8_t* here = &distance_[at(0, y)];
        from_row(here, &distance_[at(0, y + 1)]);
        for (int x = width_ - 1; x >= 0; --x) from_cell(here + x, here[x + 1]);
    }
}

void FiredMap::add_up() {
    const auto wide = static_cast<std::size_t>(width_) + 1;
    sums_.assign(wide * (static_cast<std::size_t>(height_) + 1), {});
    for (int y = 0; y < height_; ++y) {
        Sums of_row;
        const std::uint8_t* distance = &distance_[at(0, y)];
        const Sums* above = &sums_[static_cast<std::size_t>(y) * wide + 1];
        Sums* here = &sums_[(static_cast<std::size_t>(y) + 1) * wide + 1];
        for (int x = 0; x < width_; ++x) {
            const std::uint32_t d = distance[x];
            of_row.fired += d == 0 ? 1 : 0;
            of_row.distance += d;
            of_row.squared += d * d;
            here[x] = {above[x].fired + of_row.fired, above[x].distance + of_row.distance,
                       above[x].squared + of_row.squared};
        }
    }
}

FiredMap::Cells FiredMap::cells_near(double x_px, double y_px, double reach_px) const {
    const auto within = [&](double px, int cells_there) {
        return static_cast<int>(std::clamp<double>(px / cell_px_, 0, cells_there));
    };
    const auto end = [&](double px, int cells_there) {
        return px < 0 ? 0 : std::min(within(px, cells_there) + 1, cells_there);
    };
    return {within(x_px - reach_px, columns_), within(y_px - reach_px, rows_),
            end(x_px + reach_px, columns_), end(y_px + reach_px, rows_)};
}

void FiredMap::copy_row(int row, int column, std::span<std::uint8_t> to) const {
    std::fill(to.begin(), to.end(), std::uint8_t{farthest});
    const int first = std::max(column, left_);
    const int end = std::min(column + static_cast<int>(to.size()), left_ + width_);
    if (row < top_ || row >= top_ + height_ || first >= end) return;
    const std::uint8_t* const from = &distance_[at(first - left_, row - top_)];
    std::copy(from, from + (end - first), to.begin() + (first - column));
}

FiredMap::Around FiredMap::around(int column, int row, int half_side) const {
    const int left = std::clamp(column - half_side, 0, columns_);
    const int right = std::clamp(column + half_side + 1, 0, columns_);
    const int top = std::clamp(row - half_side, 0, rows_);
    const int bottom = std::clamp(row + half_side + 1, 0, rows_);
    // What of it lies in the window, and how many cells do not.
    const auto x_of = [&](int at) { return std::clamp(at - left_, 0, width_); };
    const auto y_of = [&](int at) { return std::clamp(at - top_, 0, height_); };
    const int cells = (right - left) * (bottom - top);
    const auto beyond =
        static_cast<std::uint32_t>(cells - (x_of(right) - x_of(left)) * (y_of(bottom) - y_of(top)));
    const auto wide = static_cast<std::size_t>(width_) + 1;
    const auto sums = [&](int x, int y) -> const Sums& {
        return sums_[static_cast<std::size_t>(y_of(y)) * wide + static_cast<std::size_t>(x_of(x))];
    };
    // Differences of sums that wrap are right as long as the square's own sum is below 2^32.
    const auto over = [&](std::uint32_t Sums::*member, std::uint32_t of_farthest) {
        return static_cast<double>(sums(right, bottom).*member - sums(left, bottom).*member -
                                   sums(right, top).*member + sums(left, top).*member +
                                   beyond * of_farthest);
    };
    Around around;
    const double count = std::max(cells, 1);
    around.fired = over(&Sums::fired, 0);
    around.mean = over(&Sums::distance, farthest) / count;
    around.variance = std::max(
        over(&Sums::squared, farthest * farthest) / count - around.mean * around.mean, 0.0);
    return around;
}

}  // namespace pursuit::tracker
