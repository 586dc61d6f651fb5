// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/search/drawn_contour.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "services/tracker/core/search/fired_map.hpp"

namespace pursuit::tracker {
namespace {

constexpr double finest_step_px = 0.5;
// Longer than the outline of anything with a few thousand points in an image.
constexpr double very_long_px = 100'000;

Eigen::Vector2d way_px(const Piece& piece) { return {piece.bx - piece.ax, piece.by - piece.ay}; }

}  // namespace

double drawing_step_px(double length_px, double cell_px) {
    return length_px > very_long_px ? std::max(finest_step_px, cell_px / 2) : finest_step_px;
}

std::vector<Event> drawn_contour(std::span<const Piece> pieces, const Eigen::Vector2d& from_px,
                                 Geometry geometry) {
    double length_px = 0;
    for (const Piece& piece : pieces) length_px += way_px(piece).norm();
    const int cell_px = FiredMap::cell_px_of(geometry);
    const double step_px = drawing_step_px(length_px, cell_px);
    const std::size_t columns = static_cast<std::size_t>(geometry.width / cell_px) + 1;
    std::vector<bool> is_drawn(columns * (static_cast<std::size_t>(geometry.height / cell_px) + 1));
    std::vector<Event> drawn;
    for (const Piece& piece : pieces) {
        const Eigen::Vector2d a(piece.ax, piece.ay);
        const Eigen::Vector2d along = way_px(piece);
        const int steps = static_cast<int>(std::ceil(along.norm() / step_px));
        for (int i = 0; i <= steps; ++i) {
            const Eigen::Vector2d p =
                a + static_cast<double>(i) / std::max(steps, 1) * along - from_px;
            Event event{};
            event.x = static_cast<std::uint16_t>(std::lround(p.x()));
            event.y = static_cast<std::uint16_t>(std::lround(p.y()));
            const std::size_t cell = static_cast<std::size_t>(event.y / cell_px) * columns +
                                     static_cast<std::size_t>(event.x / cell_px);
            if (is_drawn[cell]) continue;
            is_drawn[cell] = true;
            drawn.push_back(event);
        }
    }
    return drawn;
}

}  // namespace pursuit::tracker
