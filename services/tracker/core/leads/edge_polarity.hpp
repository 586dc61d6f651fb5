// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "services/tracker/core/clamped.hpp"

namespace pursuit::tracker {

/// Which polarity each piece of a contour makes as it goes along its normal, learnt while it goes
/// one way for long enough; and which way a piece goes that made an event of a polarity. As an
/// object turns back the tracked pose follows a part of a pixel late. Its way therefore says
/// "still forth" of the very events that tell that it comes back: what they lie behind the edge on
/// its way back was taken for a place ahead, and held the object up once more. But an edge that
/// brightens pixels on its way forth darkens them on its way back, from the first event on.
class EdgePolarity {
 public:
    void restart(std::size_t pieces) { edges_.assign(pieces, Edge()); }

    /// What an event tells.
    struct Told {
        double gone = 0;        ///< Which way the piece goes, −1 … 1 along its normal.
        double likelihood = 1;  ///< Of its polarity, beside that of an event that is no edge's.
    };

    /// Given which way the piece is thought to go, −1 … 1, and that it made an event of this
    /// polarity (OFF 0, ON 1). Bayes' rule for two directions, which for numbers from −1 to 1 is
    /// the addition of velocities.
    [[nodiscard, gnu::always_inline]] Told tell(std::int32_t piece, int polarity,
                                                double side) const {
        const Edge& edge = edges_[static_cast<std::size_t>(piece)];
        const double told = signs[polarity] * edge.forth;
        const double likelihood = 1 + side * edge.trust * told;
        // Nearly always it goes one way: nobody shall wait for a quotient then.
        // (Both are fetched before it is known which one it is.)
        if (std::abs(side) == 1) {
            const double against = edge.gone[0];
            const double agreeing = edge.gone[1];
            return {side * (side * told > 0 ? agreeing : against), likelihood};
        }
        return {(side * edge.trust + told) / likelihood, likelihood};
    }

    /// An event of this polarity, the object's with probability `share`, as the piece went this way
    /// (−1 or 1).
    [[gnu::always_inline]] void learn(std::int32_t piece, int polarity, double side, double share) {
        Edge& edge = edges_[static_cast<std::size_t>(piece)];
        const double forth = edge.forth + memory * share * (signs[polarity] * side - edge.forth);
        edge.forth = clamped(forth, -surest, surest);
        if (std::abs(edge.forth - edge.weighed) > slack) edge.weigh();
    }

 private:
    static constexpr double memory = 0.01;       // of an event: a few px of way
    static constexpr double surest = 0.95;       // for noise and other edges make events as well
    static constexpr double doubt = 0.2;         // of the way, where the polarity tells
    static constexpr double signs[2] = {-1, 1};  // of OFF and ON
    static constexpr double slack = 0.01;        // of what the rest is worked out for

    struct Edge {
        double forth = 0;  ///< −1 … 1: OFF … ON as the piece goes along its normal.
        double weighed = 0;
        double trust = 1;         ///< Of the way that the piece is thought to go; that way, …
        double gone[2] = {1, 1};  ///< … given that the polarity contradicts, and that it agrees.

        void weigh() {
            weighed = forth;
            const double sure = std::abs(forth);
            trust = 1 - doubt * sure;
            gone[0] = (trust - sure) / (1 - trust * sure);
            gone[1] = (trust + sure) / (1 + trust * sure);
        }
    };
    std::vector<Edge> edges_;
};

}  // namespace pursuit::tracker
