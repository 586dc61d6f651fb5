// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "services/tracker/core/geometry/coast.hpp"
#include "services/tracker/core/geometry/contour.hpp"
#include "services/tracker/core/geometry/contour_samples.hpp"
#include "services/tracker/core/noise/fired_counts.hpp"
#include "services/tracker/core/noise/fired_slice.hpp"

namespace pursuit::tracker {

/// Looks out, among steady noise, for an object that is too slow for Lookout: for the way, straight
/// on or turning, along which what fired about it in the last 160 ms speaks for it most.
///
/// A piece of a contour makes as many events as it goes across itself, and all of one polarity: ON
/// where it uncovers what is brighter, OFF where it covers it. So each piece is weighed by how it
/// would go, and asked for that polarity alone; for a dark object or a bright one, whichever stands
/// out more, and for both polarities where that does. This tells two to three times as much as
/// where events are. An object that has stopped is told by what it made until then.
class SlowLookout {
 public:
    SlowLookout() = default;
    explicit SlowLookout(const Contour& contour);

    /// Nothing was seen yet.
    void restart() {
        added_ = 0;
        filled_ = 0;
        way_.reset();
    }

    /// What fired between two looks of Lookout. Events were asked for about this place, and farther
    /// than the contour reaches.
    void add(const FiredCounts& fired, const Eigen::Vector2d& middle_px, double extent_px);

    /// Whether there is something new to look at, and enough of it.
    [[nodiscard]] bool is_due() const { return added_ == 0 && filled_ >= least_slices; }

    struct Sight {
        Coast best;                  ///< Where it is now, and how it goes if it does.
        double z = 0;                ///< How far that stands out, in standard deviations of noise.
        bool is_all_around = false;  ///< By more than a quarter of the contour.
    };
    /// The best about where it was last; gyration_px: of the contour in the image. Among all the
    /// ways that it looks along chance lifts the best to 4 as a rule.
    Sight look(const Coast& own, double gyration_px);

 private:
    static constexpr int together = 5;  // looks of Lookout: 20 ms
    static constexpr std::size_t slices = 8;
    static constexpr std::size_t least_slices = 2;

    /// By whether the piece goes outwards, and polarity: what fired where an object would have
    /// gone.
    struct Sums {
        std::array<std::array<double, 2>, 2> fired{};
        double variance = 0;

        /// Of the two polarities that an object can make on its sides.
        [[nodiscard]] double most() const {
            return std::max(fired[0][0] + fired[1][1], fired[0][1] + fired[1][0]);
        }
    };
    /// How far what fired along a way stands out, and which of the slices was the last to tell.
    struct Told {
        double z = 0;
        std::size_t newest = 0;
    };

    void weigh_overlap(const Pose& pose);
    /// Of the samples from the first to before the end.
    void add_slice(std::size_t slice, const Coast& then, std::size_t first, std::size_t end,
                   Sums& sums) const;
    [[nodiscard]] bool is_all_around(const Coast& coast, const Told& told) const;
    [[nodiscard]] double z_of(const Sums& of, const Sums& less) const;
    [[nodiscard]] Told told_by(const Coast& coast) const;
    void find_starts(const Coast& own);
    [[nodiscard]] Coast uphill(const Coast& coast, double& z) const;

    std::vector<ContourSample> samples_;  // across: outwards, where there is an inside
    bool has_inside_ = false;
    std::array<FiredSlice, slices> slices_;  // the newest first
    std::size_t filled_ = 0;
    int added_ = 0;
    std::optional<Coast> way_;  // the best, as of the last look
    std::vector<std::pair<double, Coast>> starts_;
    double sample_variance_ = 1;  // of that of a pixel
    double turn_rad_ = 0;         // that moves the contour by a px
};

}  // namespace pursuit::tracker
