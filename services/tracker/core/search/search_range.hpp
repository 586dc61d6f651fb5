// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/tracker/core/geometry/coast.hpp"
#include "services/tracker/core/geometry/pose.hpp"

namespace pursuit::tracker {

/// Where a shape may be.
struct SearchRange {
    Pose around;
    double reach_px = 0;            ///< Of T, either way in x and y.
    double angle_rad = 0;           ///< Either way; π or more: any.
    double log_scale = 0;           ///< Either way; 0 keeps the scale.
    double usual_distance_px = 30;  ///< Places so far off count one standard deviation less.

    std::vector<Pose> seeds;  ///< Poses to be looked at first, and a little preferred.
    std::vector<Pose>
        stretched;              ///< Others, which may be stretched further along the model's axes.
    bool is_check = false;      ///< Whether it is where it is thought to be: what fits best counts.
    std::int64_t since_us = 0;  ///< Events before it tell nothing.
    Coast checked;              ///< What is checked: where it is and how it goes.
    std::optional<Coast> going;  ///< How events are led on to where they would come now.
};

}  // namespace pursuit::tracker
