// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/life/track.hpp"
#include "services/tracker/core/overlap_evidence.hpp"

namespace pursuit::tracker {

/// Which object hides which. Where the contour of one lies inside another, it makes events when it
/// is in front and none when it is behind: what should have come against what came, both ways,
/// tells which, unless their depth is given. Parts that are hidden take no events.
///
/// Looked at every 2 ms of event time, over the last half second. An order that was found holds as
/// long as the two overlap, until something else is told. The pairs kept are those, and those whose
/// contours made events in each other lately.
class Occlusion {
 public:
    /// To be called before the first event at or after next_us().
    void look(std::int64_t t_us, std::span<Track> tracks);
    [[nodiscard]] std::int64_t next_us() const { return next_us_; }

    /// The tracks are others than before, or time begins anew.
    void restart();

    /// The indices of those that lie over it, as of the last look().
    [[nodiscard]] std::span<const std::size_t> over(std::size_t index) const {
        if (index >= hidden_by_.size()) return {};
        return hidden_by_[index];
    }

    /// Whether any lies over it. `index` as of the last look().
    [[nodiscard]] bool has_over(std::size_t index) const {
        return index < hidden_by_.size() && !hidden_by_[index].empty();
    }
    /// Whether an event at this place cannot be the object's, because another lies over it.
    /// `index` and `tracks` as of the last look(); has_over() holds.
    [[nodiscard]] bool hides(std::size_t index, const Event& event,
                             std::span<const Track> tracks) const {
        return is_hidden(index, event, tracks);
    }

    /// A contour this near outside that of what lies over it is hidden in the other's events.
    static constexpr double band_px = 1.5;

 private:
    using Pair = std::pair<std::uint32_t, std::uint32_t>;  ///< Ids of the inner one and the other.

    /// What tells at a glance whether two tracks may overlap.
    struct Round {
        Eigen::Vector2d t_px;
        double radius_px = 0;
    };
    void note_rounds(std::span<const Track> tracks);
    [[nodiscard]] static bool may_overlap(const Round& one, const Round& other);

    struct Overlap {
        std::size_t inner;  ///< Indices.
        std::size_t other;
    };

    void gather(const Track& one, const Track& other);
    [[nodiscard]] bool is_hidden(std::size_t index, const Event& event,
                                 std::span<const Track> tracks) const;
    bool is_behind(const Track& one, const Track& other);
    /// Whether this order was found of two that overlap, and the reverse was not.
    [[nodiscard]] bool holds(const Pair& pair) const;

    std::int64_t next_us_ = 0;
    std::int64_t last_us_ = -1;
    std::map<Pair, OverlapEvidence> evidence_;  // of the inner one's contour
    std::vector<Round> rounds_;                 // by index; where any may overlap
    std::vector<std::size_t> fronts_;           // those that can hide others
    std::vector<Overlap> overlaps_;
    std::vector<Pair> behind_;                         // of the overlaps, sorted
    std::vector<std::vector<std::size_t>> hidden_by_;  // by index: those in front of it
};

}  // namespace pursuit::tracker
