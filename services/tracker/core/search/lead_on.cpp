// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/search/lead_on.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::tracker {

void lead_on(std::span<Event> events, std::int64_t t_us, const Coast& going, Geometry geometry) {
    const Coast now = going.at(t_us, 1);
    Coast then = now;
    Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
    std::int64_t of_us = t_us;
    for (Event& event : events) {
        if (event.t_us != of_us) {
            of_us = event.t_us;
            then = now.at(of_us, 1);
            turn = rotation(now.velocity.omega_rad_s * static_cast<double>(t_us - of_us) * 1e-6);
        }
        const Eigen::Vector2d p =
            now.pose.t_px + turn * (Eigen::Vector2d(event.x, event.y) - then.pose.t_px);
        event.x =
            static_cast<std::uint16_t>(std::clamp(std::lround(p.x()), 0L, geometry.width - 1L));
        event.y =
            static_cast<std::uint16_t>(std::clamp(std::lround(p.y()), 0L, geometry.height - 1L));
    }
}

}  // namespace pursuit::tracker
