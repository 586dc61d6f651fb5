// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "services/tracker/core/clamped.hpp"

namespace pursuit::tracker {

/// How far an event comes from where its lead says, for the way that its edge has gone since its
/// pixel fired last. A pixel begins anew from what it sees after an event: so it is not the edge
/// alone that says where the next one comes.
///
/// A subsequent event is behind the last one of its pixel by just this way: those after a long one
/// come late, and the pieces of a contour that go fast across themselves have more of them where
/// pixels are blind for a while. (Where the object is so slow that EdgeContrast tells, the way is
/// short of strong edges, and in what that tells.)
///
/// An event that is its edge's first while the pixel has just fired with the other polarity, or was
/// blind until now, is none from the dark or the bright ground: such come late by half a pixel,
/// near tips and in strokes, and scatter as subsequent ones do. How late is learnt.
///
/// In the mean over the events of a lead it is nothing: what a lead is, stays. (Where pixels are
/// blind for 0.9 ms an arrow on a disc leans by 0.003 rad for all this.)
class Trail {
 public:
    void restart() { *this = Trail(); }

    /// The object is so fast now.
    void set_speed(double speed_px_s) {
        const double fast = speed_px_s * speed_px_s / (fast_px_s * fast_px_s);
        of_way_ = most_of_way * fast / (1 + fast);
    }

    /// Whether its pixel has fired so shortly before the first event of an edge that this is none
    /// from even ground. (Leads are OFF first, OFF subsequent, ON first, ON subsequent.)
    [[nodiscard]] static bool is_late(int lead, double way_px) {
        return (lead & 1) == 0 && way_px < edge_px;
    }

    /// px by which it is ahead of what its lead says.
    [[nodiscard]] double ahead(int lead, double way_px) const {
        const Polarity& polarity = of(lead);
        if ((lead & 1) != 0) {
            return of_way_ * (polarity.mean_way_px - std::min(way_px, most_way_px));
        }
        return (is_late(lead, way_px) ? polarity.late_px : 0) - polarity.mean_late_px;
    }

    /// An event that is the object's with probability `share` was ahead of all that by so much.
    [[gnu::always_inline]] void learn(int lead, double way_px, double ahead_px, double share) {
        Polarity& polarity = polarities_[static_cast<std::size_t>(lead >> 1)];
        const double gain = memory * share;
        if ((lead & 1) != 0) {
            polarity.mean_way_px += gain * (std::min(way_px, most_way_px) - polarity.mean_way_px);
            return;
        }
        const bool late = is_late(lead, way_px);
        polarity.mean_late_px += gain * ((late ? polarity.late_px : 0) - polarity.mean_late_px);
        if (late) polarity.late_px = clamped(polarity.late_px + gain * ahead_px, -1.5, 0.5);
    }

 private:
    static constexpr double edge_px = 1.5;  // as wide as a blurred edge
    static constexpr double most_way_px = 2.5;
    static constexpr double most_of_way = 0.3;  // where edges are far from even, no more shows
    static constexpr double fast_px_s = 300;    // as of EdgeContrast
    static constexpr double memory = 0.002;

    struct Polarity {
        double mean_way_px = 0.6;  // of subsequent events
        double late_px = 0;        // < 0, of late first ones …
        double mean_late_px = 0;   // … and over all first ones
    };
    [[nodiscard]] const Polarity& of(int lead) const {
        return polarities_[static_cast<std::size_t>(lead >> 1)];
    }

    std::array<Polarity, 2> polarities_{};  // OFF, ON
    double of_way_ = 0;
};

}  // namespace pursuit::tracker
