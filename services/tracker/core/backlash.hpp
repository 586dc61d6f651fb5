// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

namespace pursuit::tracker {

/// Which way each piece of a contour went last, as far as the pixels remember it: −1 … 1 along the
/// piece's normal. A pixel fires when its light has changed by a threshold since it last fired, so
/// events lead an edge whichever slow way it goes, and trail the new way until it has come back by
/// part of a pixel. The velocity tells that worse: across a fast motion a slow one is lost in it.
class Backlash {
 public:
    void restart(std::size_t pieces) { places_.assign(pieces, Place{}); }

    /// The piece has its middle here now, in the image, and this normal.
    double gone(std::int32_t piece, const Eigen::Vector2d& middle_px, const Eigen::Vector2d& n) {
        Place& place = places_[static_cast<std::size_t>(piece)];
        if (place.is_known) {
            const double way_px = n.dot(middle_px - place.middle_px);
            place.side = std::clamp(place.side + way_px / half_width_px, -1.0, 1.0);
        }
        place.middle_px = middle_px;
        place.is_known = true;
        return place.side;
    }

 private:
    static constexpr double half_width_px = 0.3;

    struct Place {
        Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
        double side = 0;
        bool is_known = false;
    };
    std::vector<Place> places_;
};

}  // namespace pursuit::tracker
