// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "services/tracker/core/coast.hpp"
#include "services/tracker/core/contour.hpp"
#include "services/tracker/core/fired_map.hpp"
#include "services/tracker/core/outline.hpp"
#include "services/tracker/core/pose.hpp"

namespace pursuit::tracker {

/// Where a shape may be.
struct SearchRange {
    Pose around;
    double reach_px = 0;            ///< Of T, either way in x and y.
    double angle_rad = 0;           ///< Either way; π or more: any.
    double log_scale = 0;           ///< Either way; 0 keeps the scale.
    double usual_distance_px = 30;  ///< Places so far off count one standard deviation less.

    std::vector<Pose> seeds;    ///< Poses to be looked at first, and a little preferred.
    bool is_check = false;      ///< Whether it is where it is thought to be: what fits best counts.
    std::int64_t since_us = 0;  ///< Events before it tell nothing.
    Coast checked;              ///< What is checked: where it is and how it goes.
    std::optional<Coast> going;  ///< How events are led on to where they would come now.
};

/// Finds a shape in what fired lately, without a good guess. What speaks for a pose is that the
/// contour lies nearer to pixels that fired than its surroundings do, in standard deviations, so
/// that clutter is not taken for a shape, and that it explains what fired there. Coarse over the
/// whole range with few points of the contour; the best are then moved to where they fit, and
/// looked at with many.
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
    /// something else leaves others of its lines unexplained.
    [[nodiscard]] double explained(const Pose& pose);
    /// The best pose where it is good enough to be tried.
    [[nodiscard]] const std::optional<Found>& found() const { return found_; }

 private:
    static constexpr int coarse_points = 24;
    static constexpr int fine_points = 72;
    static constexpr std::size_t kept = 16;
    enum class Stage { coarse, fine, done };

    /// A pose of the coarse pass, by its angle and scale, and cells.
    struct Candidate {
        double z = 0;
        std::size_t turn = 0;
        int column = 0;
        int row = 0;
    };
    struct Turn {
        double angle_rad = 0;
        double scale = 1;
        std::array<std::int16_t, coarse_points> dx{};
        std::array<std::int16_t, coarse_points> dy{};
    };
    struct Sample {
        Eigen::Vector2d at_px;      ///< Model frame.
        Eigen::Vector2d normal_px;  ///< Of length 1.
    };

    void look_at(const Turn& turn, std::size_t turn_index, int column, int row);
    void keep(const Candidate& candidate);
    /// Fits the pose, and keeps it where it is the best so far.
    void weigh(const Pose& pose, bool is_seed);
    [[nodiscard]] Pose pose_of(const Candidate& candidate) const;
    [[nodiscard]] double mean_distance(const Pose& pose) const;
    [[nodiscard]] Pose fitted(Pose pose) const;
    /// How much of the contour fired beyond chance, and how much beside it.
    struct Fit {
        double score;
        double chance;
    };
    [[nodiscard]] Fit fit_of(const Pose& pose) const;
    [[nodiscard]] std::vector<Sample> samples(int count) const;
    void draw();

    std::vector<Piece> pieces_;
    double length_px_ = 0;
    double radius_px_ = 0;
    std::vector<Sample> coarse_;
    std::vector<Sample> fine_;
    FiredMap drawn_;  // the contour itself, as if it had fired all over; drawn when asked for
    Eigen::Vector2d drawn_from_px_{0, 0};

    const FiredMap* map_ = nullptr;
    SearchRange range_;
    Stage stage_ = Stage::done;
    std::vector<Turn> turns_;
    int first_column_ = 0, end_column_ = 0;
    int first_row_ = 0, end_row_ = 0;
    int stride_ = 3;
    std::size_t turn_ = 0;
    int row_ = 0;
    int column_ = 0;
    std::vector<Candidate> best_;  // falling z
    std::size_t seed_next_ = 0;
    std::size_t fine_next_ = 0;
    std::optional<Found> found_;
};

}  // namespace pursuit::tracker
