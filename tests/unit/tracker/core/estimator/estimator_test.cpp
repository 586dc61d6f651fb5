// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "services/tracker/core/estimator/estimator.hpp"
#include "services/tracker/core/estimator/event_clock.hpp"
#include "services/tracker/core/estimator/slope.hpp"
#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow;
using test::outline_events;
using test::Poses;
using test::rms_px;
using test::small_sensor;

struct Case {
    EstimatorKind estimator;
    TransformKind transform;
    double most_px;  // mean rms error
};

class Estimating : public testing::TestWithParam<Case> {};

TEST_P(Estimating, follows_an_arrow_through_noise) {
    const auto truth = [&](double t_us) {
        const double t_s = t_us * 1e-6;
        const double grow =
            GetParam().transform == TransformKind::isometry ? 1 : 1 + 0.15 * std::sin(4 * t_s);
        const double widen = GetParam().transform == TransformKind::paper_affine ||
                                     GetParam().transform == TransformKind::full_affine
                                 ? 1 + 0.1 * std::sin(6 * t_s)
                                 : 1;
        return pose_of(120 + 60 * std::sin(2 * t_s), 100 + 30 * std::sin(3 * t_s),
                       0.8 * std::sin(2.5 * t_s), grow * widen, grow);
    };
    const Shape shape = arrow();
    const auto events = outline_events(shape, truth, 0, 1'500'000, 240, 20, small_sensor, 11);
    Tracker tracker = std::move(*Tracker::create({}));
    tracker.begin_stream(small_sensor, 1);
    Registration registration;
    registration.shape = shape;
    registration.transform = GetParam().transform;
    registration.estimator = GetParam().estimator;
    registration.start.pose = truth(0);
    registration.start.pose.t_px += Eigen::Vector2d(0.7, -0.7);
    ASSERT_TRUE(tracker.register_object(registration));
    Poses poses;
    tracker.process(events, poses);
    ASSERT_GT(poses.rows.size(), 1400U);
    double sum_px = 0;
    double velocity_error_px_s = 0;
    int count = 0;
    for (const auto& row : poses.rows) {
        if (row.record.t_us < 200'000) continue;
        const double t_s = static_cast<double>(row.record.t_us) * 1e-6;
        sum_px += rms_px(shape, row.record.pose, truth(static_cast<double>(row.record.t_us)));
        velocity_error_px_s += std::abs(row.record.velocity.vx_px_s - 120 * std::cos(2 * t_s));
        ++count;
    }
    EXPECT_LT(sum_px / count, GetParam().most_px);
    EXPECT_LT(velocity_error_px_s / count, 15);
}

INSTANTIATE_TEST_SUITE_P(
    EveryKind, Estimating,
    testing::Values(Case{EstimatorKind::gradient, TransformKind::isometry, 1.0},
                    Case{EstimatorKind::gradient, TransformKind::similarity, 1.5},
                    // The paper's rule for unequal scales is the weakest of the four.
                    Case{EstimatorKind::gradient, TransformKind::paper_affine, 2.5},
                    Case{EstimatorKind::gradient, TransformKind::full_affine, 2.0},
                    Case{EstimatorKind::kalman, TransformKind::isometry, 0.3},
                    Case{EstimatorKind::kalman, TransformKind::similarity, 0.3},
                    Case{EstimatorKind::kalman, TransformKind::paper_affine, 0.35},
                    Case{EstimatorKind::kalman, TransformKind::full_affine, 0.4}),
    [](const auto& made) {
        return std::string(to_string(made.param.estimator)) + "_" +
               std::string(to_string(made.param.transform));
    });

TEST(KalmanEstimator, follows_what_turns_fast_from_its_first_events_on) {
    // 1250 rpm: before the speed is known it goes a pixel in 0.2 ms.
    const Shape shape = test::arrow();
    const auto truth = [](double t_us) { return pose_of(160, 120, 131e-6 * t_us); };
    for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
        auto tracker = std::move(*Tracker::create({}));
        tracker.begin_stream(small_sensor, 1);
        Registration registration;
        registration.shape = shape;
        registration.estimator = EstimatorKind::kalman;
        registration.start.pose = truth(0);
        ASSERT_TRUE(tracker.register_object(registration));
        Poses poses;
        tracker.process(outline_events(shape, truth, 0, 50'000, 300, 0, small_sensor, seed), poses);
        ASSERT_FALSE(poses.rows.empty());
        double worst_px = 0;
        for (const auto& row : poses.rows) {
            const auto t_us = static_cast<double>(row.record.t_us);
            worst_px = std::max(worst_px, rms_px(shape, row.record.pose, truth(t_us)));
        }
        EXPECT_LT(worst_px, 2) << seed;
    }
}

// What happens to fire first would turn and shift it, and it would hold on to what is next to it.
TEST(KalmanEstimator, stays_by_its_start_while_the_first_events_of_a_slow_and_wrong_model_come) {
    const Shape truly = test::polygon("bar", {{-30, -12}, {30, -12}, {30, 12}, {-30, 12}});
    const auto truth = [](double t_us) { return pose_of(100 + 40e-6 * t_us, 90, 0); };
    double worst_px = 0;
    double sum_px = 0;
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        std::mt19937 random(seed);
        std::normal_distribution<float> clicks_px(0, 1);
        Shape clicked = truly;
        for (auto& p : clicked.points_px) {
            p += Eigen::Vector2f(clicks_px(random), clicks_px(random));
        }
        auto tracker = std::move(*Tracker::create({}));
        tracker.begin_stream(small_sensor, 1);
        Registration registration;
        registration.shape = clicked;
        registration.estimator = EstimatorKind::kalman;
        registration.start.pose = truth(0);
        ASSERT_TRUE(tracker.register_object(registration));
        Poses poses;
        tracker.process(outline_events(truly, truth, 0, 60'000, 160, 0, small_sensor, seed), poses);
        double off_px = 0;
        for (const auto& row : poses.rows) {
            const auto t_us = static_cast<double>(row.record.t_us);
            off_px = std::max(off_px, rms_px(truly, row.record.pose, truth(t_us)));
        }
        worst_px = std::max(worst_px, off_px);
        sum_px += off_px;
    }
    EXPECT_LT(worst_px, 3);
    EXPECT_LT(sum_px / 10, 1.75);
}

// What shows of it is the middle of its rear, which does not tell whether it goes down as well.
TEST(KalmanEstimator, goes_as_usual_where_the_little_that_shows_does_not_tell) {
    const Shape bar = test::polygon("bar", {{-30, -12}, {30, -12}, {30, 12}, {-30, 12}});
    const auto truth = [](double t_us) { return pose_of(60 + 40e-6 * t_us, 90, 0); };
    auto events = outline_events(bar, truth, 0, 500'000, 160, 0, small_sensor, 3);
    std::erase_if(events, [&](const Event& event) {
        const Eigen::Vector2d at_px =
            Eigen::Vector2d(event.x, event.y) - truth(static_cast<double>(event.t_us)).t_px;
        return at_px.x() > -20 || std::abs(at_px.y()) > 8;
    });
    const auto gone_down_px = [&](const UsualWay& way) {
        const auto estimator =
            make_estimator(EstimatorKind::kalman, TransformKind::isometry, bar, {});
        estimator->restart(truth(0), {});
        estimator->set_usual_way(way);
        estimator->set_visible_share(0.3);
        estimator->resume(0, truth(0), {40, 8, 0, 0, 0}, 0);
        for (const Event& event : events) {
            if (estimator->approach(event, {}) != nullptr) estimator->take(1);
        }
        return estimator->pose().t_px.y() - 90;
    };
    EXPECT_NEAR(gone_down_px({}), 4, 1);
    EXPECT_NEAR(gone_down_px({{40, 0, 0, 0, 0}, 1, 0.01}), 2.5, 0.5);
}

TEST(Estimators, say_whether_they_weigh_events_against_clutter_by_themselves) {
    for (const auto kind : {EstimatorKind::gradient, EstimatorKind::kalman}) {
        const auto estimator = make_estimator(kind, TransformKind::isometry, test::square(), {});
        estimator->restart(pose_of(100, 100, 0), {});
        const Approach* const near = estimator->approach({1000, 80, 80, 1}, {});
        ASSERT_NE(near, nullptr);
        EXPECT_EQ(near->is_weighed, kind == EstimatorKind::kalman);
    }
}

TEST(EventClock, tells_the_speed_by_the_rate) {
    EventClock clock;
    for (int i = 0; i < 400; ++i) {
        clock.wait(1e-3);
        clock.count(1);
    }
    // 1000 events/s, 2 events/px², 50 px: 10 px/s.
    EXPECT_NEAR(clock.speed_px_s(50), 10, 1e-9);
    EXPECT_NEAR(clock.events_per_px(50), 100, 1e-9);
}

TEST(EventClock, slows_down_in_silence) {
    EventClock clock;
    for (int i = 0; i < 400; ++i) {
        clock.wait(1e-3);
        clock.count(1);
    }
    clock.wait(0.12);
    EXPECT_NEAR(clock.speed_px_s(50), 2.5, 0.1);
}

TEST(EventClock, learns_the_density_only_from_ways_that_were_gone) {
    EventClock clock;
    clock.begin_way();
    for (int i = 0; i < 1000; ++i) clock.count(1);
    EXPECT_FALSE(clock.end_way(3.9 * 3.9, 50));
    EXPECT_EQ(clock.density(), 2);
    EXPECT_TRUE(clock.end_way(4 * 4, 50));  // 1000/(4·50) = 5 events/px²
    EXPECT_NEAR(clock.density(), 2 * std::pow(2, 0.3), 1e-12);
    clock.begin_way();
    clock.wait(0.31);
    EXPECT_TRUE(clock.end_way(1, 50));
    EXPECT_NEAR(clock.density(), 2 * std::pow(2, 0.3), 1e-12);
}

TEST(Slope, of_a_straight_line_is_exact_whatever_the_spacing) {
    Slope<1> slope(0.05);
    std::int64_t t_us = 0;
    for (int i = 0; i < 500; ++i) {
        t_us += 1000 + 777 * (i % 3);
        slope.add(t_us, Slope<1>::Values(3 + 40e-6 * static_cast<double>(t_us)));
    }
    EXPECT_NEAR(slope.per_s()(0), 40, 1e-6);
}

TEST(Slope, is_zero_before_two_samples) {
    Slope<1> slope(0.05);
    EXPECT_EQ(slope.per_s()(0), 0);
    slope.add(0, Slope<1>::Values(3));
    EXPECT_EQ(slope.per_s()(0), 0);
}

}  // namespace
}  // namespace pursuit::tracker
