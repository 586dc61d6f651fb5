// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/geometry/reach_map.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::tracker {

void ReachMap::restart(Geometry geometry, std::size_t objects) {
    const auto cells = [](std::size_t px) { return (px >> cell_bits) + 1; };
    columns_ = cells(geometry.width);
    rows_ = cells(geometry.height);
    words_ = (std::clamp(objects, std::size_t{1}, most_objects) + 63) / 64;
    is_crowded_ = objects > few_objects;
    bits_.assign(columns_ * rows_ * words_, 0);
    placed_.assign(objects, Reach{});
    told_.assign(words_ * 64, Told{});
}

void ReachMap::enter(std::size_t index, const Reach& reach) {
    Reach& placed = placed_[index];
    if (!(reach.radius_px >= 0) || !reach.center_px.allFinite()) {
        if (placed.radius_px >= 0) mark(index, placed, false);
        placed = {};
        return;
    }
    if (placed.radius_px >= 0) mark(index, placed, false);
    const bool is_close = is_crowded_ && !reach.is_sudden;
    const double around_px = is_close ? crowded_margin_px : margin_px;
    placed = {reach.center_px, reach.radius_px + around_px};
    mark(index, placed, true);
}

// The cells that the circle touches.
void ReachMap::mark(std::size_t index, const Reach& reach, bool is_there) {
    const double cell_px = 1 << cell_bits;
    const auto cell_of = [&](double px, std::size_t count) {
        const double cell = std::floor(px / cell_px);
        return std::clamp(cell, -1.0, static_cast<double>(count));
    };
    // How far a place is from a cell, along one axis.
    const auto from_cell_px = [&](double px, std::size_t cell) {
        const double first_px = static_cast<double>(cell) * cell_px;
        return std::max({first_px - px, px - (first_px + cell_px), 0.0});
    };
    const auto first_x = std::max(cell_of(reach.center_px.x() - reach.radius_px, columns_), 0.0);
    const auto first_y = std::max(cell_of(reach.center_px.y() - reach.radius_px, rows_), 0.0);
    const auto last_x = cell_of(reach.center_px.x() + reach.radius_px, columns_);
    const auto last_y = cell_of(reach.center_px.y() + reach.radius_px, rows_);
    const std::uint64_t bit = std::uint64_t{1} << (index % 64);
    for (auto y = static_cast<std::size_t>(first_y); y < rows_ && static_cast<double>(y) <= last_y;
         ++y) {
        const double off_y_px = from_cell_px(reach.center_px.y(), y);
        for (auto x = static_cast<std::size_t>(first_x);
             x < columns_ && static_cast<double>(x) <= last_x; ++x) {
            const double off_x_px = from_cell_px(reach.center_px.x(), x);
            if (off_x_px * off_x_px + off_y_px * off_y_px > reach.radius_px * reach.radius_px) {
                continue;
            }
            std::uint64_t& word = bits_[(y * columns_ + x) * words_ + index / 64];
            word = is_there ? word | bit : word & ~bit;
        }
    }
}

}  // namespace pursuit::tracker
