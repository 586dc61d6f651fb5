// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <nanoflann.hpp>
#include <random>

#include "services/tracker/core/geometry/contour.hpp"
#include "services/tracker/core/geometry/contour_edges.hpp"
#include "services/tracker/core/geometry/contour_place.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

class Random {
 public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
    }

 private:
    std::mt19937 engine_;
};

CandidateGrid::Nearest brute_force(const std::vector<Piece>& pieces, double x, double y,
                                   const ImageMetric& metric) {
    CandidateGrid::Nearest best{-1, 1e300};
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const double squared_px = pieces[i].squared_distance(x, y, metric);
        if (!(squared_px < best.squared_px)) continue;
        best = {static_cast<std::int32_t>(i), squared_px, pieces[i].foot(x, y, metric)};
    }
    return best;
}

Eigen::Matrix2d random_a(TransformKind kind, Random& random) {
    const Eigen::Matrix2d r = rotation(random.between(-3.14, 3.14));
    const double s = random.between(0.4, 2.5);
    switch (kind) {
        case TransformKind::isometry:
            return r;
        case TransformKind::similarity:
            return s * r;
        case TransformKind::paper_affine:
            return r * Eigen::Vector2d(s, random.between(0.4, 2.5)).asDiagonal();
        case TransformKind::full_affine:
            break;
    }
    return r * Eigen::Vector2d(s, random.between(0.4, 2.5)).asDiagonal() *
           rotation(random.between(-3.14, 3.14));
}

class Nearest : public testing::TestWithParam<TransformKind> {};

void expect_the_exhaustive_search(Contour contour, TransformKind kind, int poses,
                                  int queries_a_pose) {
    constexpr double reach_px = 8;
    Random random(42);
    int found = 0;
    for (int pose = 0; pose < poses; ++pose) {
        const Eigen::Matrix2d a = random_a(kind, random);
        contour.fit(a, reach_px);
        contour.fit_points(a, reach_px);
        const ImageMetric metric(a);
        const Eigen::Matrix2d inverse = a.inverse();
        for (int i = 0; i < queries_a_pose; ++i) {
            const Eigen::Vector2d image(random.between(-120, 120), random.between(-120, 120));
            const Eigen::Vector2d m = inverse * image;
            for (const CandidateGrid* grid : {&contour.points(), &contour.pieces()}) {
                const auto expected = brute_force(grid->pieces(), m.x(), m.y(), metric);
                const auto nearest = grid->nearest(m.x(), m.y(), metric);
                if (nearest.piece < 0) {
                    ASSERT_GT(expected.squared_px, reach_px * reach_px);
                    continue;
                }
                ++found;
                ASSERT_EQ(nearest.piece, expected.piece);
                ASSERT_EQ(nearest.squared_px, expected.squared_px);
                ASSERT_EQ(nearest.foot, expected.foot);
            }
        }
    }
    EXPECT_GT(found, poses * queries_a_pose / 20);
}

// Fewer where the sanitizers make each one slow.
#ifdef NDEBUG
constexpr int poses_tried = 100;
#else
constexpr int poses_tried = 5;
#endif
constexpr int queries_a_pose = 10'000;

TEST_P(Nearest, equals_the_exhaustive_search_on_a_million_random_queries) {
    expect_the_exhaustive_search(Contour(test::arrow()), GetParam(), poses_tried, queries_a_pose);
}

TEST_P(Nearest, does_so_in_a_dense_model) {
    expect_the_exhaustive_search(Contour(test::ring("ring", 20, 1500)), GetParam(), 3,
                                 queries_a_pose / 10);
}

INSTANTIATE_TEST_SUITE_P(EveryTransform, Nearest,
                         testing::Values(TransformKind::isometry, TransformKind::similarity,
                                         TransformKind::paper_affine, TransformKind::full_affine),
                         [](const auto& kind) { return std::string(to_string(kind.param)); });

/// Ten times as wide as high, or the other way round.
Eigen::Matrix2d stretched() { return Eigen::Vector2d(3, 0.3).asDiagonal(); }

TEST(NearestPiece, lists_no_more_than_so_many_a_cell_however_unequal_the_scales) {
    for (const int points : {40, 400}) {
        Contour contour(test::ring("ring", 60, points));
        contour.fit(stretched(), 8);
        contour.fit_points(stretched(), 8);
        for (const CandidateGrid* grid : {&contour.points(), &contour.pieces()}) {
            EXPECT_LE(grid->listed(), CandidateGrid::most_per_cell * grid->cells()) << points;
        }
    }
}

TEST(NearestPiece, is_as_exact_under_very_unequal_scales) {
    constexpr double reach_px = 8;
    Contour contour(test::ring("ring", 60, 400));
    contour.fit(stretched(), reach_px);
    const CandidateGrid& pieces = contour.pieces();
    const ImageMetric metric(stretched());
    Random random(9);
    int found = 0;
    for (int i = 0; i < 5'000; ++i) {
        const double x = random.between(-70, 70);
        const double y = random.between(-90, 90);
        const auto expected = brute_force(pieces.pieces(), x, y, metric);
        const auto nearest = pieces.nearest(x, y, metric);
        if (expected.squared_px > reach_px * reach_px) continue;
        ++found;
        ASSERT_EQ(nearest.piece, expected.piece);
        ASSERT_EQ(nearest.squared_px, expected.squared_px);
        ASSERT_EQ(nearest.foot, expected.foot);
    }
    EXPECT_GT(found, 500);
}

template <TransformKind k>
struct Of {
    static constexpr TransformKind kind = k;
};
template <class T>
class PlaceOnContour : public testing::Test {};
using Kinds = testing::Types<Of<TransformKind::isometry>, Of<TransformKind::similarity>,
                             Of<TransformKind::paper_affine>, Of<TransformKind::full_affine>>;
TYPED_TEST_SUITE(PlaceOnContour, Kinds);

TEST(NearestPiece, agrees_with_a_kd_tree_on_a_large_model) {
    using Points = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
    Random random(3);
    Shape shape{"dots", {}, {}};
    for (int i = 0; i < 4096; ++i) {
        shape.points_px.emplace_back(random.between(-300, 300), random.between(-200, 200));
    }
    shape = without_repeats(shape);
    const auto count = static_cast<Eigen::Index>(shape.points_px.size());
    ASSERT_GT(count, 4000);
    Points matrix(count, 2);
    for (Eigen::Index i = 0; i < count; ++i) {
        matrix.row(i) = shape.points_px[static_cast<std::size_t>(i)].cast<double>().transpose();
    }
    const nanoflann::KDTreeEigenMatrixAdaptor<Points, 2> tree(2, std::cref(matrix));
    Contour contour(shape);
    contour.fit_points(Eigen::Matrix2d::Identity(), 60);
    for (int i = 0; i < 20'000; ++i) {
        const Eigen::Vector2d m(random.between(-300, 300), random.between(-200, 200));
        Eigen::Index expected = 0;
        double squared_px = 0;
        tree.index->knnSearch(m.data(), 1, &expected, &squared_px);
        const auto nearest = contour.points().nearest(m.x(), m.y(), ImageMetric());
        ASSERT_EQ(nearest.piece, expected);
        ASSERT_DOUBLE_EQ(nearest.squared_px, squared_px);
    }
}

TEST(NearestPiece, is_beyond_reach_where_it_finds_nothing_and_nowhere_within_reach) {
    constexpr double reach_px = 6;
    CandidateGrid grid({{-20, -10, 20, -10}, {20, -10, 0, 25}, {0, 25, -20, -10}});
    EXPECT_TRUE(grid.is_beyond(0, -10)) << "nothing is laid out yet";
    grid.build(reach_px, 1);
    Random random(7);
    int beyond = 0;
    for (int i = 0; i < 100'000; ++i) {
        const double x = random.between(-60, 60);
        const double y = random.between(-60, 60);
        const auto nearest = brute_force(grid.pieces(), x, y, ImageMetric());
        const double distance_px = std::sqrt(nearest.squared_px);
        const bool is_beyond = grid.is_beyond(x, y);
        if (distance_px < reach_px) {
            EXPECT_FALSE(is_beyond) << x << ", " << y;
        }
        EXPECT_EQ(is_beyond, grid.nearest(x, y, ModelMetric()).piece < 0) << x << ", " << y;
        beyond += is_beyond ? 1 : 0;
    }
    EXPECT_GT(beyond, 1000);
    EXPECT_LT(beyond, 99'000);
}

TYPED_TEST(PlaceOnContour, tells_where_its_line_is_and_how_it_goes_in_a_turn) {
    Random random(7);
    const Contour contour(test::arrow());
    CandidateGrid grid = contour.pieces();
    grid.build(30, 4);
    int found = 0;
    for (int i = 0; i < 2000; ++i) {
        const Eigen::Matrix2d a = random_a(TypeParam::kind, random);
        const Eigen::Vector2d q(random.between(-50, 50), random.between(-50, 50));
        const ContourPlace place = place_on_contour<TypeParam::kind>(grid, a, q, 8);
        if (place.piece < 0) continue;
        ++found;
        const Eigen::Vector2d& n = place.n;
        const Eigen::Vector2d& arm = place.arm_px;
        EXPECT_NEAR(place.line_px, n.dot(arm), 1e-9);
        EXPECT_NEAR(place.line_px + place.r_px, n.dot(q), 1e-9);
        EXPECT_NEAR(place.turning_px, n.y() * arm.x() - n.x() * arm.y(), 1e-9);
    }
    EXPECT_GT(found, 100);
}

TEST(NearestPiece, finds_the_one_place_of_a_model_that_is_a_line) {
    const CandidateGrid grid({{-10, 0, 10, 0}}, 5, 1);
    const auto nearest = grid.nearest(3, -4, ImageMetric());
    EXPECT_EQ(nearest.piece, 0);
    EXPECT_DOUBLE_EQ(nearest.squared_px, 16);
    EXPECT_EQ(grid.nearest(200, 0, ImageMetric()).piece, -1);
    EXPECT_EQ(grid.nearest(std::nan(""), 0, ImageMetric()).piece, -1);
}

TEST(Contour, names_the_pieces_that_end_at_each_point) {
    Shape shape;
    shape.name = "flag and a speck";
    shape.points_px = {{0, 0}, {0, 10}, {8, 10}, {8, 5}, {0, 5}, {30, 30}};
    shape.edges = {{0, 4}, {4, 1}, {1, 2}, {2, 3}, {3, 4}};
    const Contour contour(shape);
    const auto& pieces = contour.pieces().pieces();
    for (std::int32_t point = 0; point < 6; ++point) {
        const Eigen::Vector2f& p = shape.points_px[static_cast<std::size_t>(point)];
        std::vector<std::uint16_t> ending;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const bool from = pieces[i].ax == p.x() && pieces[i].ay == p.y();
            const bool to = pieces[i].bx == p.x() && pieces[i].by == p.y();
            if (from || to) ending.push_back(static_cast<std::uint16_t>(i));
        }
        const auto named = contour.pieces_at(point);
        EXPECT_EQ(std::vector(named.begin(), named.end()), ending) << "point " << point;
    }
    EXPECT_EQ(contour.pieces_at(4).size(), 3);
    EXPECT_EQ(contour.pieces_at(5).size(), 1);
}

TEST(Contour, is_laid_out_anew_where_what_it_was_built_for_is_far_more_than_needed) {
    constexpr double reach_px = 8;
    const Eigen::Matrix2d equal = Eigen::Matrix2d::Identity();
    for (const Eigen::Matrix2d& before : {stretched(), Eigen::Matrix2d(0.02 * equal)}) {
        Contour contour(test::arrow());
        contour.fit(before, reach_px);
        contour.fit_points(before, reach_px);
        contour.forget_excess(equal, reach_px);
        EXPECT_EQ(contour.pieces().nearest(0, 0, ModelMetric()).piece, -1);
        contour.fit(equal, reach_px);
        contour.fit_points(equal, reach_px);
        for (const CandidateGrid* grid : {&contour.points(), &contour.pieces()}) {
            EXPECT_LT(grid->anisotropy(), 1.01);
            EXPECT_LT(grid->reach_px(), 2 * reach_px);
        }
    }
}

TEST(Contour, stays_as_it_is_laid_out_for_little_more_than_needed) {
    Contour contour(test::arrow());
    const Eigen::Matrix2d wider = Eigen::Vector2d(1.4, 0.8).asDiagonal();
    contour.fit(wider, 30);
    const double anisotropy = contour.pieces().anisotropy();
    contour.forget_excess(Eigen::Matrix2d::Identity(), 4);
    contour.fit(Eigen::Matrix2d::Identity(), 4);
    EXPECT_EQ(contour.pieces().anisotropy(), anisotropy);
}

TEST(Contour, keeps_a_point_that_no_edge_touches) {
    Shape shape{"three", {{0, 0}, {10, 0}, {0, 50}}, {{0, 1}}};
    const Contour contour(shape);
    EXPECT_EQ(contour.pieces().pieces().size(), 2U);
    EXPECT_DOUBLE_EQ(contour.length_px(), 10);
}

}  // namespace
}  // namespace pursuit::tracker
