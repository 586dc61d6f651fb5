// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/search/coarse_search.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <numbers>
#include <random>

#include "services/common/event.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::anywhere;

constexpr double shape_radius_px = 40;

/// Points along an outline that no turn maps onto itself.
std::vector<Eigen::Vector2d> samples_px() {
    std::vector<Eigen::Vector2d> samples;
    for (int i = 0; i < CoarseSearch::points; ++i) {
        const double angle_rad = 2 * std::numbers::pi * i / CoarseSearch::points;
        const double r_px =
            shape_radius_px * (0.55 + 0.45 * std::cos(angle_rad) * std::sin(angle_rad / 2));
        samples.emplace_back(r_px * std::cos(angle_rad), r_px * std::sin(angle_rad));
    }
    return samples;
}

constexpr double shape_length_px = 2 * std::numbers::pi * 0.6 * shape_radius_px;

FiredMap map_of(const std::vector<Pose>& poses, int noise, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<Event> events;
    const auto put = [&](double x_px, double y_px) {
        if (!(x_px >= 0 && y_px >= 0 && x_px < 304 && y_px < 240)) return;
        events.push_back({static_cast<std::int64_t>(events.size()),
                          static_cast<std::uint16_t>(x_px), static_cast<std::uint16_t>(y_px), 1});
    };
    const auto samples = samples_px();
    for (const Pose& pose : poses) {
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const Eigen::Vector2d& next = samples[(i + 1) % samples.size()];
            for (int k = 0; k < 10; ++k) {
                const Eigen::Vector2d p =
                    pose.t_px + pose.a * (samples[i] + (next - samples[i]) * k / 10);
                put(p.x() + 0.5, p.y() + 0.5);
            }
        }
    }
    for (int i = 0; i < noise; ++i) {
        const auto x_px = static_cast<double>(random() % 304);
        put(x_px, static_cast<double>(random() % 240));
    }
    FiredMap map;
    map.build(test::small_sensor, events);
    return map;
}

/// How far the outline lies nearer to what fired than its surroundings do, in standard deviations.
double z_of(const FiredMap& map, const Pose& pose) {
    const int column = static_cast<int>(pose.t_px.x());
    const int row = static_cast<int>(pose.t_px.y());
    const double scale = std::sqrt(pose.a.determinant());
    const auto around =
        map.around(column, row, static_cast<int>(0.8 * shape_radius_px * scale + 1e-9) + 2);
    double sum = 0;
    for (const Eigen::Vector2d& sample_px : samples_px()) {
        const Eigen::Vector2d d_px = pose.a * sample_px;
        sum += map.distance(column + static_cast<int>(std::round(d_px.x())),
                            row + static_cast<int>(std::round(d_px.y())));
    }
    const double deviation = std::sqrt(std::max(around.variance, 1.0) / CoarseSearch::points);
    return (around.mean - sum / CoarseSearch::points) / deviation;
}

std::vector<Pose> found(const FiredMap& map, const SearchRange& range, int slice = 1'000'000) {
    CoarseSearch search(samples_px(), shape_radius_px, shape_length_px);
    search.begin(map, range);
    while (!search.is_done()) {
        int poses = slice;
        search.step(poses);
    }
    std::vector<Pose> best;
    for (std::size_t i = 0; i < search.count(); ++i) best.push_back(search.pose(i));
    return best;
}

SearchRange about(const Pose& pose, double reach_px, double angle_rad) {
    SearchRange range;
    range.around = pose;
    range.reach_px = reach_px;
    range.angle_rad = angle_rad;
    return range;
}

TEST(CoarseSearch, keeps_nothing_worse_than_any_pose_of_its_grid_looked_at_plainly) {
    const Pose truth = pose_of(117, 83, 0.9);
    const FiredMap map = map_of({truth}, 400, 1);
    const std::vector<Pose> best = found(map, about(pose_of(120, 90, 0.6), 45, 0.8));
    ASSERT_FALSE(best.empty());
    // The grid: every third cell, and turns of 4 px at the rim.
    constexpr int angles = 16;  // 2 · 0.8 rad · 40 px / 4 px
    double highest_z = 0;
    for (int row = 45; row <= 135; row += 3) {
        for (int column = 75; column <= 165; column += 3) {
            for (int i = 0; i < angles; ++i) {
                const double angle_rad = 0.6 - 0.8 + (i + 0.5) * 1.6 / angles;
                highest_z = std::max(highest_z, z_of(map, pose_of(column, row, angle_rad)));
            }
        }
    }
    EXPECT_DOUBLE_EQ(z_of(map, best.front()), highest_z);
    EXPECT_LT((best.front().t_px - truth.t_px).norm(), 3);
    for (std::size_t i = 1; i < best.size(); ++i) {
        EXPECT_GE(z_of(map, best[i - 1]), z_of(map, best[i])) << i;
    }
}

TEST(CoarseSearch, keeps_at_most_sixteen_poses_apart_from_each_other) {
    const FiredMap map =
        map_of({pose_of(70, 70, 0.2), pose_of(220, 90, 2.5), pose_of(150, 180, -1.5)}, 0, 2);
    const std::vector<Pose> best = found(map, anywhere());
    ASSERT_GE(best.size(), 3U);
    EXPECT_LE(best.size(), 16U);
    for (std::size_t i = 0; i < best.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const Eigen::Vector2d apart_px = (best[i].t_px - best[k].t_px).cwiseAbs();
            const double turned_rad =
                std::remainder(theta_rad(best[i].a) - theta_rad(best[k].a), 2 * std::numbers::pi);
            EXPECT_TRUE(apart_px.maxCoeff() > 6 || std::abs(turned_rad) >= 0.3) << i << " " << k;
        }
    }
}

TEST(CoarseSearch, finds_a_shape_in_any_turn_and_size_and_at_the_rim_of_the_image) {
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
        const double scale = std::exp(-0.27 + 0.07 * seed);
        const Pose truth =
            pose_of(seed % 2 == 0 ? 30 : 150, seed % 4 < 2 ? 215 : 100, 0.8 * seed, scale, scale);
        const std::vector<Pose> best = found(map_of({truth}, 200, seed), anywhere());
        const auto is_near = [&](const Pose& pose) {
            return (pose.t_px - truth.t_px).norm() < 6 &&
                   std::abs(std::remainder(theta_rad(pose.a) - theta_rad(truth.a),
                                           2 * std::numbers::pi)) < 0.3;
        };
        EXPECT_TRUE(std::any_of(best.begin(), best.end(), is_near)) << seed;
    }
}

TEST(CoarseSearch, keeps_the_same_however_it_is_cut_into_steps) {
    const FiredMap map = map_of({pose_of(100, 100, 1), pose_of(200, 150, 2)}, 300, 4);
    const std::vector<Pose> whole = found(map, anywhere());
    for (const int slice : {1, 7, 500}) {
        const std::vector<Pose> parts = found(map, anywhere(), slice);
        ASSERT_EQ(parts.size(), whole.size()) << slice;
        for (std::size_t i = 0; i < parts.size(); ++i) EXPECT_EQ(parts[i], whole[i]) << slice;
    }
}

TEST(CoarseSearch, keeps_nothing_where_nothing_has_fired) {
    EXPECT_TRUE(found(map_of({}, 0, 5), anywhere()).empty());
}

TEST(CoarseSearch, keeps_a_shape_among_noise_before_all_that_noise_alone_makes) {
    const FiredMap noise = map_of({}, 3000, 6);
    const FiredMap both = map_of({pose_of(150, 120, 0.7)}, 3000, 6);
    double of_noise_z = 0;
    for (const Pose& pose : found(noise, anywhere())) {
        of_noise_z = std::max(of_noise_z, z_of(noise, pose));
    }
    const std::vector<Pose> best = found(both, anywhere());
    ASSERT_FALSE(best.empty());
    EXPECT_GT(z_of(both, best.front()), of_noise_z);
    EXPECT_LT((best.front().t_px - Eigen::Vector2d(150, 120)).norm(), 4);
}

TEST(CoarseSearch, stays_in_its_range) {
    const FiredMap map = map_of({pose_of(60, 60, 0), pose_of(240, 180, 0)}, 0, 7);
    const SearchRange range = about(pose_of(240, 170, 0), 20, 0.5);
    const std::vector<Pose> best = found(map, range);
    ASSERT_FALSE(best.empty());
    for (const Pose& pose : best) {
        EXPECT_LE((pose.t_px - range.around.t_px).cwiseAbs().maxCoeff(), 20.5);
        EXPECT_LE(std::abs(theta_rad(pose.a)), 0.5);
        EXPECT_NEAR(pose.a.determinant(), 1, 1e-9);
    }
}

}  // namespace
}  // namespace pursuit::tracker
