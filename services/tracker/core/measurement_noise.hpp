// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pursuit::tracker {

/// How events scatter about the contour that made them, leads and offsets taken into account: most
/// by a part of a pixel, some by much more (the tail). The variance adapts to what comes.
///
/// Where events lie much farther from the contour than that explains, the model is another than the
/// object, as one taken from a recording of something that turns in depth: a sharp look would hold
/// on to what is next to it. So the tail then has more of them, and is wider.
class MeasurementNoise {
 public:
    void restart() { gain_ = 1; }

    /// What an event at a residual tells.
    struct Told {
        double near_px2;             ///< Variance of most events, …
        double tail_px2;             ///< … and what the tail's has more.
        double per_near_variance;    ///< 1 over the residual's, the state's own included.
        double near_likelihood = 0;  ///< Densities over r, 1/px.
        double tail_likelihood = 0;

        [[nodiscard]] double likelihood() const { return near_likelihood + tail_likelihood; }
        /// Of a measurement with the mean information of both.
        [[nodiscard]] double variance_px2() const {
            const double far_px2 = near_px2 + tail_px2;
            return likelihood() * near_px2 * far_px2 /
                   (near_likelihood * far_px2 + tail_likelihood * near_px2);
        }
    };

    /// state_px2: what the residual is uncertain by for the state's sake. (Always inlined, as is
    /// what else every event asks for: gcc would not.)
    [[nodiscard, gnu::always_inline]] Told at(double r_px, double state_px2,
                                              bool is_subsequent) const {
        const double sigma_px = is_subsequent ? subsequent_px : first_px;
        Told told{};
        told.near_px2 = sigma_px * sigma_px * gain_;
        const double near_variance = state_px2 + told.near_px2;
        told.per_near_variance = 1 / near_variance;
        const double misfit = std::max(gain_ - misfit_gain, 0.0);
        const double share = std::min(tail_share + tail_share_of_misfit * misfit, most_tail_share);
        told.tail_px2 = tail_px2 * (1 + tail_of_misfit * misfit);
        told.near_likelihood = (1 - share) * normal_density(r_px * r_px, told.per_near_variance);
        told.tail_likelihood =
            share * normal_density(r_px * r_px, 1 / (near_variance + told.tail_px2));
        return told;
    }

    /// The event was the object's with probability `share`.
    void learn(double r_px, const Told& told, double share) {
        const double surprise = std::min(r_px * r_px * told.per_near_variance, 9.0) / 1.3 - 1;
        gain_ = std::clamp(gain_ * (1 + memory * share * surprise), least_gain, most_gain);
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
    static constexpr double least_gain = 0.2;
    static constexpr double most_gain = 16;
    static constexpr double memory = 0.001;

    // In single precision: the densities are weighed against each other, to a few digits.
    static float normal_density(double r2, double per_variance) {
        return std::exp(static_cast<float>(-0.5 * r2 * per_variance)) *
               std::sqrt(static_cast<float>(per_variance * (0.5 / std::numbers::pi)));
    }

    double gain_ = 1;  // g_R
};

}  // namespace pursuit::tracker
