// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "services/tracker/core/clamped.hpp"

namespace pursuit::tracker {

/// How events scatter about the contour that made them, leads and offsets taken into account: most
/// by a part of a pixel, some by much more (the tail). The variance adapts to what comes: from that
/// of a model which is somewhat wrong, so that what happens to fire first does not turn and shift
/// it before the rest of the contour has told.
///
/// Where events lie much farther from the contour than that explains, the model is another than the
/// object, as one taken from a recording of something that turns in depth: a sharp look would hold
/// on to what is next to it. So the tail then has more of them, and is wider.
///
/// What this says changes slowly: roots and quotients are taken anew when it has changed by some
/// percent, and not with every event.
class MeasurementNoise {
 public:
    MeasurementNoise() { restart(); }
    /// is_doubted: the model may be somewhat wrong; else it begins as usual.
    void restart(bool is_doubted = true) {
        gain_ = is_doubted ? first_gain : 1;
        weigh(0);
    }

    /// What an event at a residual tells.
    struct Told {
        double near_px2;           ///< Variance of most events, …
        double far_px2;            ///< … and of those of the tail.
        double half_per_variance;  ///< 1/2 over the residual's, the state's own included.
        double near_likelihood;    ///< Densities over r, 1/px.
        double tail_likelihood;

        [[nodiscard]] double likelihood() const { return near_likelihood + tail_likelihood; }
        /// Of a measurement with the mean information of both.
        [[nodiscard]] double variance_px2() const {
            return likelihood() * near_px2 * far_px2 / per_information();
        }
        /// share / (state_px2 + variance_px2()) for the share of a likelihood, times that of the
        /// event's polarity, that is the object's beside clutter, at once: the next event waits
        /// for this.
        [[nodiscard]] double share_per_variance(double of_polarity, double clutter,
                                                double state_px2) const {
            const double sum = likelihood();
            const double own = sum * of_polarity;
            const double of = per_information();
            return own * of / ((own + clutter) * (state_px2 * of + sum * near_px2 * far_px2));
        }

     private:
        [[nodiscard]] double per_information() const {
            return near_likelihood * far_px2 + tail_likelihood * near_px2;
        }
    };

    /// state_px2: what the residual is uncertain by for the state's sake. (Always inlined, as is
    /// what else every event asks for: gcc would not.)
    [[nodiscard, gnu::always_inline]] Told at(double r_px, double state_px2, bool is_subsequent) {
        if (std::abs(state_px2 - state_px2_) > slack_px2_ || ++since_weighed_ > weighed_every) {
            weigh(state_px2);
        }
        const Kind& kind = kinds_[is_subsequent ? 1 : 0];
        const double r2 = r_px * r_px;
        return {kind.near_px2, kind.far_px2, kind.half_per_near,
                kind.near_height * fading(r2 * kind.part_per_near),
                kind.tail_height * fading(r2 * kind.part_per_tail)};
    }

    /// The event was the object's with probability `share`.
    void learn(double r_px, const Told& told, double share) {
        constexpr double per_usual = 1 / 1.3;
        const double misfit = clamped(2 * r_px * r_px * told.half_per_variance, 0, 9);
        gain_ =
            clamped(gain_ * (1 + memory * share * (misfit * per_usual - 1)), least_gain, most_gain);
    }

    /// Of the variance, beside what is usual.
    [[nodiscard]] double gain() const { return gain_; }

 private:
    static constexpr double first_px = 0.4;       // σ of a pixel's first event of an edge
    static constexpr double subsequent_px = 0.6;  // σ of those that follow
    static constexpr double tail_px2 = 1.5 * 1.5;
    static constexpr double tail_share = 0.2;
    static constexpr double misfit_gain = 2;
    static constexpr double tail_share_of_misfit = 0.1;
    static constexpr double most_tail_share = 0.5;
    static constexpr double tail_of_misfit = 0.5;
    // Before its events have told otherwise a model may be wrong by as much as they scatter, as
    // clicked ones are. (With more, clicked models start somewhat better still, and what is slow in
    // 100 Hz of noise is lost more often.)
    static constexpr double first_gain = 2;
    static constexpr double least_gain = 0.2;
    static constexpr double most_gain = 16;
    static constexpr double memory = 0.001;
    // The gain changes by less than a percent meanwhile; the variance by less than these parts.
    static constexpr int weighed_every = 32;
    static constexpr double slack_of_near = 0.1;
    static constexpr double parts = 16;  // that fading() takes an exponent in: a power of two

    /// Of first and of subsequent events.
    struct Kind {
        double near_px2, far_px2;
        double half_per_near;                 // 1/2 over the residual's variance
        double part_per_near, part_per_tail;  // the same by `parts`
        double near_height, tail_height;      // of the densities
    };

    /// exp(−16·u), u ≥ 0: within a third of a percent to 16·u = 4, and never less than 2e-8, far
    /// below the tail. By squaring, in fewer steps than the library's, and the same on every
    /// processor. (The next event waits for it: so the 16 is in what u is made of.)
    static double fading(double u) {
        const double v = at_most(u, 1);
        double e = (1 - v) + v * v * (0.5 - v * (1.0 / 6));
        e *= e;
        e *= e;
        e *= e;
        return e * e;
    }

    void weigh(double state_px2) {
        state_px2_ = state_px2;
        since_weighed_ = 0;
        slack_px2_ = slack_of_near * (state_px2 + first_px * first_px * gain_);
        const double misfit = std::max(gain_ - misfit_gain, 0.0);
        const double share = std::min(tail_share + tail_share_of_misfit * misfit, most_tail_share);
        const double more_px2 = tail_px2 * (1 + tail_of_misfit * misfit);
        for (std::size_t i = 0; i < kinds_.size(); ++i) {
            const double sigma_px = i == 1 ? subsequent_px : first_px;
            Kind& kind = kinds_[i];
            kind.near_px2 = sigma_px * sigma_px * gain_;
            kind.far_px2 = kind.near_px2 + more_px2;
            const double near_variance = state_px2 + kind.near_px2;
            kind.half_per_near = 0.5 / near_variance;
            const double half_per_tail = 0.5 / (near_variance + more_px2);
            kind.part_per_near = kind.half_per_near / parts;
            kind.part_per_tail = half_per_tail / parts;
            kind.near_height = (1 - share) * std::sqrt(kind.half_per_near / std::numbers::pi);
            kind.tail_height = share * std::sqrt(half_per_tail / std::numbers::pi);
        }
    }

    double gain_ = first_gain;  // g_R
    double state_px2_ = 0;
    double slack_px2_ = 0;
    int since_weighed_ = 0;
    std::array<Kind, 2> kinds_{};
};

}  // namespace pursuit::tracker
