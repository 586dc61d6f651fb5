// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/leads/contour_offsets.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::tracker {
namespace {

// All pieces are gone through each time: for large models less often, so that an event never costs
// more than a few of them.
constexpr int least_between = 256;
constexpr int between_per_piece = 4;

constexpr double regular = 1e-6;

int freedoms_of(TransformKind kind) {
    switch (kind) {
        case TransformKind::isometry:
            return 3;
        case TransformKind::similarity:
            return 4;
        case TransformKind::paper_affine:
        case TransformKind::full_affine:
            break;
    }
    return 6;
}

}  // namespace

ContourOffsets::ContourOffsets(const Contour& contour, TransformKind kind)
    : per_gyration_(1 / std::max(contour.gyration_px(), 1.0)), freedoms_(freedoms_of(kind)) {
    const std::vector<Piece>& pieces = contour.pieces().pieces();
    settled_every_ = std::max(least_between, between_per_piece * static_cast<int>(pieces.size()));
    mean_px_.resize(pieces.size());
    Eigen::Matrix<double, most_freedoms, most_freedoms> normal =
        Eigen::Matrix<double, most_freedoms, most_freedoms>::Identity() * regular;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Piece& piece = pieces[i];
        const double length_px = std::hypot(piece.bx - piece.ax, piece.by - piece.ay);
        if (!(length_px > 0)) continue;
        rows_.push_back({i, length_px, along(piece, length_px)});
        const Freedoms& row = rows_.back().along;
        normal += length_px * row * row.transpose();
    }
    normal_.compute(normal);
    restart();
}

void ContourOffsets::restart() {
    mean_px_.assign(mean_px_.size(), 0);
    variance_px2_.assign(mean_px_.size(), sigma_px * sigma_px);
    told_share_ = 0;
    learnt_ = 0;
}

ContourOffsets::Freedoms ContourOffsets::along(const Piece& piece, double length_px) const {
    const double nx = (piece.by - piece.ay) / length_px;
    const double ny = (piece.ax - piece.bx) / length_px;
    const double x = (piece.ax + piece.bx) / 2 * per_gyration_;
    const double y = (piece.ay + piece.by) / 2 * per_gyration_;
    Freedoms row = Freedoms::Zero();
    row(0) = nx;
    row(1) = ny;
    if (freedoms_ == most_freedoms) {
        row.tail<4>() << nx * x, nx * y, ny * x, ny * y;
    } else {
        row(2) = ny * x - nx * y;
        if (freedoms_ == 4) row(3) = nx * x + ny * y;
    }
    return row;
}

void ContourOffsets::settle() {
    learnt_ = 0;
    Freedoms right = Freedoms::Zero();
    for (const Row& row : rows_) right += row.length_px * mean_px_[row.piece] * row.along;
    const Freedoms moved = normal_.solve(right);
    double squares_px2 = 0;
    double known = 0;
    for (const Row& row : rows_) {
        double& mean_px = mean_px_[row.piece];
        mean_px -= row.along.dot(moved);
        const double share = 1 - variance_px2_[row.piece] / (sigma_px * sigma_px);
        squares_px2 += share * mean_px * mean_px;
        known += share;
    }
    told_share_ =
        squares_px2 > 0 ? std::max(1 - physics_px * physics_px * known / squares_px2, 0.0) : 0.0;
}

}  // namespace pursuit::tracker
