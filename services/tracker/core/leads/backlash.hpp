// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "services/tracker/core/clamped.hpp"

namespace pursuit::tracker {

/// Which way each piece of a contour went last, as far as the pixels remember it: −1 … 1 along the
/// piece's normal. A pixel fires when its light has changed by a threshold since it last fired, so
/// events lead an edge whichever slow way it goes, and trail the new way until it has come back by
/// part of a pixel. The velocity tells that worse: across a fast motion a slow one is lost in it.
class Backlash {
 public:
    void restart(std::size_t pieces) { places_.assign(pieces, Place{}); }

    /// The piece has its middle at t + arm now, in the image, and this normal; n_arm: n·arm, which
    /// may be known before the arm is.
    double gone(std::int32_t piece, const Eigen::Vector2d& t_px, const Eigen::Vector2d& arm_px,
                const Eigen::Vector2d& n, double n_arm_px) {
        Place& place = places_[static_cast<std::size_t>(piece)];
        if (place.is_known) {
            const double way_px = n.dot(t_px - place.middle_px) + n_arm_px;
            const double before = place.side;
            const double now = before + way_px * (1 / half_width_px);
            place.side = clamped(now, -1, 1);
            const bool has_turned = before * place.side <= 0;
            place.since_turn_px = has_turned ? now * half_width_px : place.since_turn_px + way_px;
        }
        place.middle_px = t_px + arm_px;
        place.is_known = true;
        return place.side;
    }

    /// Whether the piece has gone this way for so long that nothing is left of another.
    [[nodiscard]] bool is_settled(std::int32_t piece) const {
        return std::abs(of(piece).since_turn_px) > settled_px;
    }
    /// Whether the piece is still on the pixels on which it turned back.
    [[nodiscard]] bool has_turned(std::int32_t piece) const {
        return std::abs(of(piece).since_turn_px) < turned_px;
    }

 private:
    static constexpr double half_width_px = 0.3;
    static constexpr double settled_px = 0.8;
    static constexpr double turned_px = 1.6;  // as wide as a blurred edge

    struct Place {
        Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
        double side = 0;
        double since_turn_px = 0;
        bool is_known = false;
    };
    [[nodiscard]] const Place& of(std::int32_t piece) const {
        return places_[static_cast<std::size_t>(piece)];
    }
    std::vector<Place> places_;
};

}  // namespace pursuit::tracker
