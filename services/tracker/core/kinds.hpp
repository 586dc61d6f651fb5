// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace pursuit::tracker {

/// What the pose of an object may do. The values are those on the wire (idl/poses.idl).
enum class TransformKind {
    isometry,      ///< A = R(θ)
    similarity,    ///< A = s·R(θ)
    paper_affine,  ///< A = R(θ)·diag(sx, sy): the paper's affine
    full_affine,   ///< A free
};

/// How an event moves the pose. The values are those on the wire (idl/models.idl).
enum class EstimatorKind {
    gradient,  ///< The paper's descent, equations (3.2)–(3.11).
    kalman,    ///< A filter on pose, twist and event leads.
};

/// Which object takes an event that is near several. The values are those on the wire.
enum class StrategyKind {
    closest,
    reject_all,
    update_all,
    weighted,
    temporal,
    spatiotemporal,
    probabilistic,
};

/// Where a track stands. The values are those on the wire (idl/poses.idl).
enum class TrackState {
    searching,  ///< No pose yet.
    tracking,   ///< The pose follows the object's events; also while the object stands still.
    occluded,   ///< The object's events stopped matching; the pose coasts on the velocity.
    lost,       ///< The pose says nothing any more.
};

/// Why a track is lost. (What tells it: docs/tracking.md.)
enum class LossCause {
    not_lost,
    does_not_fit,    ///< Events came that are not those of the object at its pose.
    gone,            ///< All that it covered changed at once: taken away, or replaced.
    in_noise,        ///< Steady noise leaves next to nothing of what is on its contour to it.
    not_seen_again,  ///< Its events were missing, or it was hidden, for longer than it may coast.
    out_of_bounds,   ///< Its events moved the pose out of the bounds of check(Pose).
};
constexpr std::size_t loss_causes = 6;

std::string_view to_string(TransformKind kind);
std::string_view to_string(EstimatorKind kind);
std::string_view to_string(StrategyKind kind);
std::string_view to_string(TrackState state);  ///< SEARCHING, TRACKING, OCCLUDED, LOST
std::string_view to_string(LossCause cause);   ///< As it is called above.

/// The kind of that name as to_string() gives it; nothing for any other text.
std::optional<TransformKind> parse_transform(std::string_view text);
std::optional<EstimatorKind> parse_estimator(std::string_view text);
std::optional<StrategyKind> parse_strategy(std::string_view text);
std::optional<TrackState> parse_track_state(std::string_view text);

/// The names that parse_…() takes, as "a, b or c": for messages.
std::string transform_names();
std::string estimator_names();
std::string strategy_names();

}  // namespace pursuit::tracker
