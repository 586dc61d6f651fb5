// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/tracker/core/geometry/contour.hpp"
#include "services/tracker/core/geometry/outline.hpp"
#include "services/tracker/core/geometry/pose.hpp"
#include "services/tracker/core/search/coarse_search.hpp"
#include "services/tracker/core/search/fired_map.hpp"
#include "services/tracker/core/search/search_range.hpp"

namespace pursuit::tracker {

/// Finds a shape in what fired lately, without a good guess: coarse over the whole range with few
/// points of the contour (CoarseSearch); the best are then moved to where they fit, and looked at
/// with many. What speaks for these is that more of the contour fired than what lies beside it, so
/// that clutter is not taken for a shape, and that it explains what fired there.
///
///     begin() ─► coarse ─► fine ─► done
///
/// The work is done in slices by step(), so that no event waits for it.
class ShapeSearch {
 public:
    ShapeSearch() = default;
    explicit ShapeSearch(const Contour& contour);
    /// Looks for what of the contour is not hidden.
    ShapeSearch(const Contour& contour, const Outline& outline);

    /// The map must outlive the search and stay as it is until is_done().
    void begin(const FiredMap& map, const SearchRange& range);

    /// Looks at up to `poses` more poses.
    void step(int poses);
    [[nodiscard]] bool is_done() const { return stage_ == Stage::done; }

    struct Found {
        Pose pose;
        double score = 0;     ///< 0 chance … 1: how much of the contour fired, beyond chance.
        bool is_sure = true;  ///< Good enough by itself; others only a check finds.
    };
    /// How well a pose fits as it is.
    [[nodiscard]] double score_of(const Pose& pose) const { return fit_of(pose).score; }
    /// Of what fired near the contour, the share that fired on it, 0 … 1: what lies on lines of
    /// something else leaves others of its lines unexplained. Where stretched poses are looked at,
    /// of all that fired near any of them: what is small explains less.
    [[nodiscard]] double explained(const Pose& pose);
    /// The best pose where it is good enough to be tried.
    [[nodiscard]] const std::optional<Found>& found() const { return found_; }

 private:
    static constexpr int fine_points = 72;
    enum class Stage { coarse, fine, done };

    struct Sample {
        Eigen::Vector2d at_px;      ///< Model frame.
        Eigen::Vector2d normal_px;  ///< Of length 1.
    };

    enum class From { seed, stretched, grid };
    /// Fits the pose, and keeps it where it is the best so far.
    void weigh(const Pose& pose, From from);
    [[nodiscard]] double mean_distance(const Pose& pose) const;
    [[nodiscard]] Pose fitted(Pose pose, bool stretches) const;
    /// How much of the contour fired beyond chance, and how much beside it.
    struct Fit {
        double score;
        double chance;
    };
    [[nodiscard]] Fit fit_of(const Pose& pose) const;
    /// Cells that fired.
    struct Fired {
        int on_it = 0;  ///< Of those near the contour.
        int near_it = 0;
    };
    [[nodiscard]] Fired fired_near(const Pose& pose);
    [[nodiscard]] std::vector<Sample> samples(int count) const;
    void draw();

    std::vector<Piece> pieces_;
    double length_px_ = 0;
    double radius_px_ = 0;
    std::vector<Sample> fine_;
    FiredMap drawn_;  // the contour itself, as if it had fired all over; drawn when asked for
    Eigen::Vector2d drawn_from_px_{0, 0};

    const FiredMap* map_ = nullptr;
    SearchRange range_;
    Stage stage_ = Stage::done;
    CoarseSearch coarse_;
    std::size_t seed_next_ = 0;
    std::size_t counted_next_ = 0;  // of the stretched
    std::size_t stretched_next_ = 0;
    std::size_t fine_next_ = 0;
    std::optional<Found> found_;
    double highest_rank_ = 0;
    double fired_about_ = 1;  // cells near any of the stretched poses, where there are some
};

}  // namespace pursuit::tracker
