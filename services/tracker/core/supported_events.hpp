// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/geometry/coast.hpp"
#include "services/tracker/core/geometry/silhouette.hpp"
#include "services/tracker/core/pixels/chance_support.hpp"
#include "services/tracker/core/pixels/last_events.hpp"

namespace pursuit::tracker {

/// What a search looks at: the last events of a part of the image that a neighbour in space and
/// time supports, as those of an edge are, and few of noise.
class SupportedEvents {
 public:
    struct Wish {
        Eigen::Vector2d around_px = Eigen::Vector2d::Zero();
        double reach_px = 0;  ///< From there, along each axis.
        std::int64_t since_us = 0;
        std::int64_t neighbour_us = 0;  ///< So shortly before an event a neighbour of it fired.
        double noise_share = 0;         ///< Of noise, at most, has as many neighbours by chance.
        std::size_t most = 0;           ///< The last so many of them.
    };

    /// What lies over what is looked for, and how it goes: what comes from there is left out.
    struct Cover {
        Silhouette silhouette;
        Coast now;
    };

    void restart(Geometry geometry) { geometry_ = geometry; }

    /// Of those until t_us.
    void gather(std::int64_t t_us, LastEvents& last, const Wish& wish,
                std::span<const Cover> covers);

    /// In the order they came; to be led on in place.
    [[nodiscard]] std::vector<Event>& events() { return events_; }
    /// How many of all that fired there have such neighbours, 0 … 1: of even noise
    /// Wish::noise_share at most; 0 where nothing fired.
    [[nodiscard]] double supported_share() const { return supported_share_; }
    /// Of them, at t_us; 0 where there is none.
    [[nodiscard]] double mean_age_us(std::int64_t t_us) const;

 private:
    [[nodiscard]] LastEvents::Box box_of(const Wish& wish) const;
    /// Those that have no more neighbours than noise has that was looked at for so long.
    void leave_out_noise(double over_us, const Wish& wish);

    Geometry geometry_;
    std::vector<Event> events_;
    double supported_share_ = 0;
    std::vector<std::uint8_t> neighbours_;  // that fired shortly before, of each
    ChanceSupport chance_;
    // By pixel looked at, while gathering, since the first that is looked at; never in between.
    std::vector<std::int32_t> fired_us_;
    std::vector<std::size_t> looked_at_;  // the pixels
};

}  // namespace pursuit::tracker
