// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/tracker/core/geometry/contour.hpp"
#include "services/tracker/core/kinds.hpp"

namespace pursuit::tracker {

/// How far beside each piece of a contour its events come, in px of the image along the piece's
/// normal: a clicked or an extracted model is a pixel wrong here and there, in the same way all the
/// time. A filter that takes this for noise that is new with every event believes itself too much,
/// and leans on whatever part of the contour shows or moves most; with the offsets learnt, the part
/// that still shows of a half-hidden object keeps it where all of it had it.
///
/// What the transform itself could do (for an isometry a shift and a turn) is no offset: it is
/// taken out again and again, all of the contour counting alike. And offsets are told only as far
/// as they stand out of what physics leaves: the corners that blur rounds, the leads that differ a
/// little.
class ContourOffsets {
 public:
    ContourOffsets(const Contour& contour, TransformKind kind);

    /// Nothing is known.
    void restart();

    /// The object is so fast now.
    void set_speed(double speed_px_s) {
        const double fast = speed_px_s / fast_px_s;
        noise_of_speed_px2_ = noise_px2 * (1 + fast * fast);
    }

    [[nodiscard]] double of(std::int32_t piece) const {
        return told_share_ * mean_px_[static_cast<std::size_t>(piece)];
    }

    /// An event of this piece, which has a length, came so far beside it, the told offset and leads
    /// taken into account; share: 0 … 1, that it is the object's. The faster it moves, the more of
    /// the distance is what a pixel's delays make of the speed. (A point has no side: of one, every
    /// event is beside it the same way.)
    [[gnu::always_inline]] void learn(std::int32_t piece, double residual_px, double share) {
        const auto i = static_cast<std::size_t>(piece);
        const double gain = share * variance_px2_[i] / (variance_px2_[i] + noise_of_speed_px2_);
        mean_px_[i] += gain * (residual_px + (told_share_ - 1) * mean_px_[i]);
        variance_px2_[i] = std::max((1 - gain) * variance_px2_[i], least_sigma_px * least_sigma_px);
        if (++learnt_ == settled_every_) settle();
    }

 private:
    static constexpr double sigma_px = 0.4;        // of an offset before anything is known
    static constexpr double least_sigma_px = 0.1;  // so that what was learnt wrong is unlearnt
    static constexpr double noise_px2 = 20;        // of an event: correlated over many
    static constexpr double fast_px_s = 1000;
    static constexpr double physics_px = 0.1;  // rms of offsets that say nothing of the model
    static constexpr int most_freedoms = 6;
    using Freedoms = Eigen::Matrix<double, most_freedoms, 1>;

    /// How the offset of a piece changes with each freedom of the transform.
    [[nodiscard]] Freedoms along(const Piece& piece, double length_px) const;
    /// Takes out what the transform could do, and finds how much of the rest is told.
    void settle();

    struct Row {
        std::size_t piece = 0;
        double length_px = 0;
        Freedoms along;
    };
    std::vector<Row> rows_;  // of the pieces that have a length
    Eigen::LDLT<Eigen::Matrix<double, most_freedoms, most_freedoms>> normal_;
    double per_gyration_ = 0;
    int freedoms_ = 0;
    std::vector<double> mean_px_;
    std::vector<double> variance_px2_;
    double told_share_ = 0;
    double noise_of_speed_px2_ = noise_px2;
    int learnt_ = 0;
    int settled_every_ = 0;
};

}  // namespace pursuit::tracker
