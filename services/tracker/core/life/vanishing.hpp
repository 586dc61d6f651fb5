// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/clamped.hpp"
#include "services/tracker/core/geometry/pose.hpp"
#include "services/tracker/core/geometry/silhouette.hpp"
#include "services/tracker/core/life/fit_since.hpp"

namespace pursuit::tracker {

/// Whether the object is gone. What stands still makes no events, nor does what is not there; but
/// at the instant at which a shape is taken away or another is put in its place, all that it
/// covered changes at once: events come from all over its inside within a few ms, where else few
/// come, and then its contour makes no more of them.
///
///     watching ── all of the inside fires at once ──► suspected ── its events fail to come ──►
///     gone
///        ▲                                               │
///        └── it was the light, or an edge that passed ◄──┤
///        └── its contour makes events as before ◄────────┘
///
/// What fires about the shape as well as in it is the light; what fires on one side first and on
/// the other last is an edge that passes. A shape without enough of an inside is never suspected.
///
/// What is put in its place covers some of what it covered, and some of what is about it: only a
/// part of the inside fires, and what is about fires as in the light. So whatever it was but an
/// edge that passes, when more than a third of the inside has changed at once, what comes after it
/// has to fit as usual. What does not is another's. (Of silence then nothing is told: the object
/// may stand still.)
class Vanishing {
 public:
    Vanishing() = default;
    /// radius_px: of the shape about its centre.
    Vanishing(const Silhouette& silhouette, double radius_px);

    /// Watches anew: what is usual is to be learnt again.
    void restart();

    /// The shape has an inside to be watched.
    [[nodiscard]] bool can_tell() const { return inside_px2_ > 0; }

    /// How far from the centre an event can be and tell anything, px of the model frame.
    [[nodiscard]] double reach_px() const { return reach_px_; }

    /// An event, and where the object is. since_same_us: since the last one of the same pixel and
    /// polarity.
    void see(const Event& event, const Pose& pose, std::int64_t since_same_us) {
        // A pixel counts once.
        if (since_same_us <= window_us || !can_tell()) return;
        const Eigen::Matrix2d& a = pose.a;
        const Eigen::Vector2d q = Eigen::Vector2d(event.x, event.y) - pose.t_px;
        const double determinant = a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0);
        const double cells_per_determinant = cells_per_px_ / determinant;
        const double right = (a(1, 1) * q.x() - a(0, 1) * q.y()) * cells_per_determinant;
        const double down = (a(0, 0) * q.y() - a(1, 0) * q.x()) * cells_per_determinant;
        // Farther away there is nothing in the map: of many objects' maps that is not in the cache.
        if (right * right + down * down > farthest2_cells2_) return;
        // The map's rim is nowhere.
        const double last = 2 * middle_ - 1;
        const double column = clamped(right + middle_, 0, last);
        const double row = clamped(down + middle_, 0, last);
        const std::uint8_t cell =
            map_[static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column)];
        if (cell == nowhere) return;
        note(event, cell, {column, row}, std::abs(determinant));
    }

    /// Some events within the gate of the contour, the last at this time: so many of them within a
    /// quarter of the gate, and so many not. usual_share: of them within a quarter of it; 0 where
    /// what comes says nothing of it.
    void count_own(std::int64_t t_us, int sharp, int astray, double usual_share) {
        if (!can_tell()) return;
        reach(t_us);
        // What comes from anywhere makes nothing on the average.
        constexpr double of_astray = chance / (1 - chance);
        const double of_contour = sharp - of_astray * astray;
        own_.now += of_contour;
        // What comes much later is of another time.
        if (!is_suspected() && t_us >= changed_us_ + longest_us) changed_us_ = -1;
        if (changed_us_ < 0 || t_us < changed_us_ + window_us) return;
        since_.count(sharp, astray, usual_share);
        if (is_suspected()) {
            own_since_ += of_contour;
            own_variance_ += sharp + of_astray * of_astray * astray;
            const double more = own_since_ - needed_;
            if (more > 0 && more * more >= beyond_chance * beyond_chance * own_variance_ &&
                since_.is_as_usual()) {
                // It fires all over by itself: what is usual has changed.
                suspected_us_ = changed_us_ = -1;
                began_us_ = t_us;
                bins_ = 0;
            }
        } else if (t_us >= changed_us_ + verdict_us) {
            if (since_.is_against()) {
                suspected_us_ = changed_us_;
            } else if (since_.is_as_usual()) {
                changed_us_ = -1;
            }
        }
    }

    [[nodiscard]] bool is_suspected() const { return suspected_us_ >= 0; }
    [[nodiscard]] bool is_gone(std::int64_t t_us) const {
        return is_suspected() && t_us >= suspected_us_ + verdict_us;
    }

    /// Nothing nearer to the contour tells anything, image px.
    static constexpr double nearest_px = 0.9;

    static constexpr std::int64_t bin_us = 2'500;
    static constexpr std::int64_t window_us = 2 * bin_us;
    static constexpr std::int64_t verdict_us = 35'000;
    static constexpr std::int64_t longest_us = 100'000;
    static constexpr std::size_t cells = 16;

 private:
    /// Events of the bin that runs and of the one before it, and how many a bin has usually.
    struct Count {
        double now = 0;
        double before = 0;
        double usual = 0;

        [[nodiscard]] double more() const { return now + before - 2 * usual; }
    };
    /// Of times and places of the events inside, of one polarity.
    struct Sums {
        double n = 0, x = 0, y = 0, t = 0, xx = 0, xy = 0, yy = 0, xt = 0, yt = 0, tt = 0;
    };

    static constexpr std::uint8_t about = cells;  // of the map: next to the shape
    static constexpr std::uint8_t nowhere = cells + 1;
    static constexpr double chance = 0.25;
    static constexpr double beyond_chance = 2.5;  // σ

    void divide(std::vector<std::size_t>& places, std::size_t first, std::size_t last,
                std::size_t cell, std::size_t count);
    void reach(std::int64_t t_us) {
        if (t_us >= bin_end_us_) next_bin(t_us);
    }
    void next_bin(std::int64_t t_us);
    /// An event in a cell; its place in the map; image px² of a model px².
    void note(const Event& event, std::uint8_t cell, const Eigen::Vector2d& place,
              double image_per_model2);
    void mark(std::size_t cell);
    [[nodiscard]] bool is_of_object() const;
    [[nodiscard]] double share_of_passing() const;

    double middle_ = 0;  // of the map, a square about the centre: half as many cells as it has
    double cells_per_px_ = 1;
    double reach_px_ = 0;
    double farthest2_cells2_ = 0;  // from the centre, of a place that is somewhere, squared
    std::size_t columns_ = 0;
    std::vector<std::uint8_t> map_;         // which cell of the inside, or about, or nowhere
    std::array<double, cells> cell_px2_{};  // model frame
    double inside_px2_ = 0;
    double about_px2_ = 0;

    std::int64_t began_us_ = -1;
    std::int64_t bin_end_us_ = 0;
    double bins_ = 0;
    double image_per_model2_ = 1;
    std::array<Count, cells> inside_{};
    Count about_{};
    Count own_{};
    std::array<Sums, 2> sums_now_{};  // of the bin that runs, by polarity
    std::array<Sums, 2> sums_before_{};
    std::uint32_t fired_ = 0;  // a bit for each cell
    std::int64_t suspected_us_ = -1;
    std::int64_t changed_us_ = -1;  // a part of the inside or all of it; since then:
    FitSince since_;
    double own_since_ = 0;
    double own_variance_ = 0;
    double needed_ = 0;
};

}  // namespace pursuit::tracker
