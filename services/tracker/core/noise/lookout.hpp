// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/geometry/coast.hpp"
#include "services/tracker/core/geometry/contour.hpp"
#include "services/tracker/core/geometry/pose.hpp"
#include "services/tracker/core/noise/fired_beside.hpp"
#include "services/tracker/core/noise/fired_counts.hpp"
#include "services/tracker/core/noise/fired_window.hpp"

namespace pursuit::tracker {

/// Looks out, among steady noise, for where an object is and how it goes: what fired lately about
/// it is counted pixel by pixel, and the contour laid over the counts in every pose close by, then
/// moved uphill, its velocity with it. Where an object moves, its contour covers more than it does
/// anywhere else. One that stands makes no events, and none of the places stands out.
///
/// How far a place stands out is told in standard deviations of noise alone, z. Of all the places
/// that a look goes through, chance alone lifts the best to 3 as a rule, and to 5 once in some
/// thousand looks.
class Lookout {
 public:
    Lookout() = default;
    explicit Lookout(const Contour& contour);

    /// Nothing was seen yet.
    void restart() { window_.restart(); }

    /// An event about the object.
    void see(const Event& event) {
        window_.see(event.x, event.y, event.polarity);
        seen_ = event;
    }
    /// It is another object's. (Where that one was not seen, an earlier one of its pixel stays.)
    void disown(const Event& event) {
        if (event == seen_) window_.forget(event.x, event.y, event.polarity);
    }
    /// What was seen since the last look.
    [[nodiscard]] const FiredCounts& fresh() const { return window_.fresh(); }

    /// What a look shows.
    struct Sight {
        double own_z = 0;              ///< Of where the object is thought to be.
        std::optional<Coast> instead;  ///< It is rather here, beyond chance.
        double instead_z = 0;
        bool is_even = true;  ///< Beside the contour there is noise alone. Else nothing is instead.
    };
    /// Looks at what was seen since the last look and in the four times before it; everywhere, or
    /// where the object is thought to be alone. To be called every every_us of event time.
    /// gyration_px, extent_px: of the contour in the image.
    Sight look(const Coast& own, double gyration_px, double extent_px, bool everywhere);

    /// A shape that maps onto itself stands out as much in each of its turns: of those of what the
    /// last look found, the one nearest to this angle.
    [[nodiscard]] Coast nearest_turn(const Coast& found, double near_rad) const;

    static constexpr std::int64_t every_us = 4'000;
    static constexpr int reach_px = 6;    ///< Places looked at: in x and y, each way, …
    static constexpr int reach_turn = 8;  ///< … and turned by so many px of the gyration.
    /// Larger objects would take too long to look for.
    static constexpr double most_extent_px = 120;

 private:
    static constexpr std::size_t parts = 8;
    static constexpr std::size_t places = 2 * reach_px + 1;
    static constexpr std::size_t turns = 2 * reach_turn + 1;

    void weigh_noise(const Pose& pose);
    void look_around(const Coast& own, const Velocity& going);
    void look_elsewhere(const Coast& own, Sight& sight);
    [[nodiscard]] bool is_even(const Coast& own, const std::optional<Coast>& instead);
    [[nodiscard]] std::array<double, parts> scores_of(const Coast& coast) const;
    [[nodiscard]] double z_of(const Coast& coast) const;
    [[nodiscard]] bool is_all_around(const Coast& coast, double z) const;
    [[nodiscard]] Coast uphill(const Coast& coast, double& z) const;
    [[nodiscard]] Coast best_of_around(const Coast& own, const Velocity& going) const;

    std::vector<Eigen::Vector2d> left_out_;  // so near to each other that nothing is in between
    std::vector<Eigen::Vector2d> samples_;   // model frame, evenly along the contour
    Eigen::Vector2d middle_px_{0, 0};        // of them
    double turn_rad_ = 0;                    // of a step
    FiredWindow window_;                     // a slice for each look
    Event seen_{-1, 0, 0, 0};                // the last one
    std::vector<float> work_;
    FiredBeside beside_;
    std::vector<float> scores_;  // [turn][y][x]
    double mean_ = 0;            // of a score in noise alone
    double sigma_ = 1;
};

}  // namespace pursuit::tracker
