// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/leads/contour_offsets.hpp"

#include <gtest/gtest.h>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

constexpr double slow_px_s = 40;

/// Everything that each piece is off, learnt from events that come by turns.
ContourOffsets learnt_from(const Contour& contour, TransformKind kind,
                           const std::vector<double>& off_px, int rounds,
                           double speed_px_s = slow_px_s) {
    ContourOffsets offsets(contour, kind);
    offsets.set_speed(speed_px_s);
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < off_px.size(); ++i) {
            const auto piece = static_cast<std::int32_t>(i);
            offsets.learn(piece, off_px[i] - offsets.of(piece), 1);
        }
    }
    return offsets;
}

/// What the shape's pieces are off where it is moved and turned: nothing that a model has wrong.
std::vector<double> off_by_a_move(const Contour& contour, double x_px, double y_px,
                                  double angle_rad) {
    std::vector<double> off_px;
    for (const Piece& piece : contour.pieces().pieces()) {
        const Eigen::Vector2d along(piece.bx - piece.ax, piece.by - piece.ay);
        const Eigen::Vector2d n(along.y() / along.norm(), -along.x() / along.norm());
        const Eigen::Vector2d m((piece.ax + piece.bx) / 2, (piece.ay + piece.by) / 2);
        off_px.push_back(
            n.dot(Eigen::Vector2d(x_px, y_px) + angle_rad * Eigen::Vector2d(-m.y(), m.x())));
    }
    return off_px;
}

TEST(ContourOffsets, are_none_where_nothing_was_learnt) {
    const Contour contour(test::arrow());
    const ContourOffsets offsets(contour, TransformKind::isometry);
    EXPECT_EQ(offsets.of(0), 0);
}

TEST(ContourOffsets, come_near_to_what_every_piece_is_off) {
    const Contour contour(test::arrow());
    const std::size_t count = contour.pieces().pieces().size();
    std::vector<double> off_px(count);
    for (std::size_t i = 0; i < count; ++i) off_px[i] = i % 2 == 0 ? 0.6 : -0.6;
    const auto moves = learnt_from(contour, TransformKind::isometry, off_px, 2000);
    double error_px = 0;
    for (std::size_t i = 0; i < count; ++i) {
        error_px += std::abs(moves.of(static_cast<std::int32_t>(i)) - off_px[i]) /
                    static_cast<double>(count);
    }
    EXPECT_LT(error_px, 0.15);
}

TEST(ContourOffsets, leave_to_the_pose_what_the_pose_can_do) {
    const Contour contour(test::arrow());
    const auto off_px = off_by_a_move(contour, 0.5, -0.3, 0.01);
    for (const auto kind : {TransformKind::isometry, TransformKind::similarity,
                            TransformKind::paper_affine, TransformKind::full_affine}) {
        const auto offsets = learnt_from(contour, kind, off_px, 2000);
        for (std::size_t i = 0; i < off_px.size(); ++i) {
            ASSERT_NEAR(offsets.of(static_cast<std::int32_t>(i)), 0, 0.02) << i;
        }
    }
}

TEST(ContourOffsets, do_not_tell_what_is_no_more_than_physics_leaves) {
    const Contour contour(test::arrow());
    std::vector<double> off_px(contour.pieces().pieces().size());
    for (std::size_t i = 0; i < off_px.size(); ++i) off_px[i] = i % 2 == 0 ? 0.05 : -0.05;
    const auto offsets = learnt_from(contour, TransformKind::isometry, off_px, 2000);
    for (std::size_t i = 0; i < off_px.size(); ++i) {
        ASSERT_EQ(offsets.of(static_cast<std::int32_t>(i)), 0) << i;
    }
}

TEST(ContourOffsets, are_learnt_slowly_from_what_is_fast) {
    const Contour contour(test::arrow());
    std::vector<double> off_px(contour.pieces().pieces().size());
    for (std::size_t i = 0; i < off_px.size(); ++i) off_px[i] = i % 2 == 0 ? 0.6 : -0.6;
    const auto slow = learnt_from(contour, TransformKind::isometry, off_px, 60);
    const auto fast = learnt_from(contour, TransformKind::isometry, off_px, 60, 10'000);
    double of_slow = 0;
    double of_fast = 0;
    for (std::size_t i = 0; i < off_px.size(); ++i) {
        of_slow += std::abs(slow.of(static_cast<std::int32_t>(i)));
        of_fast += std::abs(fast.of(static_cast<std::int32_t>(i)));
    }
    EXPECT_LT(of_fast, 0.1 * of_slow);
}

TEST(ContourOffsets, are_unlearnt_at_a_restart) {
    const Contour contour(test::arrow());
    std::vector<double> off_px(contour.pieces().pieces().size());
    for (std::size_t i = 0; i < off_px.size(); ++i) off_px[i] = i % 2 == 0 ? 0.6 : -0.6;
    auto offsets = learnt_from(contour, TransformKind::isometry, off_px, 2000);
    EXPECT_NE(offsets.of(0), 0);
    offsets.restart();
    EXPECT_EQ(offsets.of(0), 0);
}

}  // namespace
}  // namespace pursuit::tracker
