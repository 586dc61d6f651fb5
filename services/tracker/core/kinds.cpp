// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/kinds.hpp"

#include <array>

namespace pursuit::tracker {
namespace {

// Each table is in the order of its enum.
constexpr std::array<std::string_view, 4> transforms{"isometry", "similarity", "paper_affine",
                                                     "full_affine"};
constexpr std::array<std::string_view, 2> estimators{"gradient", "kalman"};
constexpr std::array<std::string_view, 7> strategies{"closest",      "reject_all", "update_all",
                                                     "weighted",     "temporal",   "spatiotemporal",
                                                     "probabilistic"};
constexpr std::array<std::string_view, 4> states{"SEARCHING", "TRACKING", "OCCLUDED", "LOST"};
constexpr std::array<std::string_view, loss_causes> causes{
    "not_lost", "does_not_fit", "gone", "in_noise", "not_seen_again", "out_of_bounds"};

template <class Kind, std::size_t N>
std::string_view name_of(const std::array<std::string_view, N>& names, Kind kind) {
    const auto index = static_cast<std::size_t>(kind);
    return index < N ? names[index] : "unknown";
}

template <class Kind, std::size_t N>
std::optional<Kind> kind_of(const std::array<std::string_view, N>& names, std::string_view text) {
    for (std::size_t i = 0; i < N; ++i) {
        if (names[i] == text) return static_cast<Kind>(i);
    }
    return std::nullopt;
}

template <std::size_t N>
std::string listed(const std::array<std::string_view, N>& names) {
    std::string text(names[0]);
    for (std::size_t i = 1; i < N; ++i) {
        text += i + 1 == N ? " or " : ", ";
        text += names[i];
    }
    return text;
}

}  // namespace

std::string_view to_string(TransformKind kind) { return name_of(transforms, kind); }
std::string_view to_string(EstimatorKind kind) { return name_of(estimators, kind); }
std::string_view to_string(StrategyKind kind) { return name_of(strategies, kind); }
std::string_view to_string(TrackState state) { return name_of(states, state); }
std::string_view to_string(LossCause cause) { return name_of(causes, cause); }

std::optional<TransformKind> parse_transform(std::string_view text) {
    return kind_of<TransformKind>(transforms, text);
}
std::optional<EstimatorKind> parse_estimator(std::string_view text) {
    return kind_of<EstimatorKind>(estimators, text);
}
std::optional<StrategyKind> parse_strategy(std::string_view text) {
    return kind_of<StrategyKind>(strategies, text);
}
std::optional<TrackState> parse_track_state(std::string_view text) {
    return kind_of<TrackState>(states, text);
}

std::string transform_names() { return listed(transforms); }
std::string estimator_names() { return listed(estimators); }
std::string strategy_names() { return listed(strategies); }

}  // namespace pursuit::tracker
