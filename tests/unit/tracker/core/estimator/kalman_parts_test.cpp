// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/estimator/kalman_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow;
using test::outline_events;
using test::Poses;
using test::rms_px;
using test::small_sensor;

struct Part {
    std::string left_out;
    TransformKind transform = TransformKind::isometry;
    double noise_per_ms = 20;
    double wider = 1;    ///< What is seen is so much wider than the model, …
    double bend = 0;     ///< … and bent, as a plane in perspective.
    double most_px = 2;  ///< (Among noise it is carried off: that is what the part is for.)
    std::int64_t until_us = 600'000;
};

/// What is there to be seen.
Shape seen(const Part& of) {
    Shape shape = arrow();
    for (Eigen::Vector2f& point : shape.points_px) {
        point *= static_cast<float>(of.wider) /
                 (1 + static_cast<float>(of.bend) * (point.x() + point.y()) / 30);
    }
    return shape;
}

/// Goes to and fro and turns, slowly enough for levels to be crossed again.
Pose truth(double t_us) {
    const double t_s = t_us * 1e-6;
    return pose_of(120 + 12 * std::sin(5 * t_s), 100 + 8 * std::sin(7 * t_s),
                   0.4 * std::sin(4 * t_s), 1, 1);
}

/// Where it was thought to be, each ms, with this switched off from the start or, where it names
/// none, with all parts.
Poses followed(const Part& of, const std::vector<NamedValue>& parameters) {
    Tracker tracker = Tracker::create({}).value();
    tracker.begin_stream(small_sensor, 1);
    Registration registration;
    registration.shape = arrow();
    registration.transform = of.transform;
    registration.estimator = EstimatorKind::kalman;
    registration.parameters = parameters;
    registration.start.pose = truth(0);
    tracker.register_object(registration).value();
    Poses poses;
    tracker.process(
        outline_events(seen(of), truth, 0, of.until_us, 60, of.noise_per_ms, small_sensor, 5),
        poses);
    return poses;
}

double mean_rms_px(const Poses& poses) {
    double sum_px = 0;
    for (const auto& row : poses.rows) {
        sum_px += rms_px(arrow(), row.record.pose, truth(static_cast<double>(row.record.t_us)));
    }
    return sum_px / static_cast<double>(poses.rows.size());
}

class LeftOut : public testing::TestWithParam<Part> {};

TEST_P(LeftOut, changes_the_poses_and_the_object_is_followed_without_it) {
    const Poses with = followed(GetParam(), {});
    const Poses without = followed(GetParam(), {{GetParam().left_out, 0}});
    ASSERT_EQ(with.rows.size(), without.rows.size());
    ASSERT_GT(with.rows.size(), 500U);
    bool differs = false;
    for (std::size_t i = 0; i < with.rows.size() && !differs; ++i) {
        differs = with.rows[i].record.pose.t_px != without.rows[i].record.pose.t_px;
    }
    EXPECT_TRUE(differs);
    EXPECT_LT(mean_rms_px(without), GetParam().most_px);
}

INSTANTIATE_TEST_SUITE_P(
    EveryPart, LeftOut,
    testing::Values(Part{"uses_event_clock"}, Part{"remembers_pace"}, Part{"uses_leads"},
                    Part{"holds_leads"}, Part{"learns_trail"}, Part{"tells_contrast"},
                    Part{"tells_polarity"}, Part{"remembers_levels"}, Part{"hears_silence"},
                    Part{"learns_steadiness"}, Part{"measures_clutter"}, Part{"adapts_noise"},
                    Part{"watches_noise", TransformKind::isometry, 900, 1, 0, 12},
                    Part{"learns_offsets", TransformKind::isometry, 20, 1.05, 0, 2, 2'000'000},
                    Part{"learns_bend", TransformKind::full_affine, 20, 1, 0.1, 3}),
    [](const auto& made) { return made.param.left_out; });

TEST(KalmanParts, are_all_in_use_and_none_is_where_all_are_left_out) {
    ObjectParameters parameters;
    const KalmanParts all(parameters);
    EXPECT_TRUE(all.event_clock && all.pace && all.leads && all.lead_physics && all.trail &&
                all.contrast && all.polarity && all.levels && all.quiet_facings && all.steadiness &&
                all.clutter && all.measurement_noise && all.noise_watch && all.offsets && all.bend);
    for (const auto& line : object_parameter_table()) {
        if (line.min == 0 && line.max == 1 && parameters.*(line.member) == 1) {
            parameters.*(line.member) = 0;
        }
    }
    const KalmanParts none(parameters);
    EXPECT_FALSE(none.event_clock || none.pace || none.leads || none.lead_physics || none.trail ||
                 none.contrast || none.polarity || none.levels || none.quiet_facings ||
                 none.steadiness || none.clutter || none.measurement_noise || none.noise_watch ||
                 none.offsets || none.bend);
}

TEST(KalmanParts, can_all_be_left_out_and_put_back_while_an_object_is_followed) {
    std::vector<NamedValue> left_out;
    for (const auto& line : object_parameter_table()) {
        if (line.min == 0 && line.max == 1 && ObjectParameters{}.*(line.member) == 1) {
            left_out.push_back({std::string(line.name), 0});
        }
    }
    ASSERT_EQ(left_out.size(), 15U);
    std::vector<NamedValue> put_back = left_out;
    for (NamedValue& value : put_back) value.value = 1;
    Tracker tracker = test::that_follows_an_arrow(truth(0));
    Poses poses;
    const auto events = outline_events(arrow(), truth, 0, 900'000, 60, 20, small_sensor, 5);
    std::size_t begin = 0;
    for (int part = 0; part < 9; ++part) {
        const std::size_t end = events.size() * static_cast<std::size_t>(part + 1) / 9;
        tracker.process({events.data() + begin, end - begin}, poses);
        begin = end;
        ASSERT_TRUE(tracker.set_parameters("arrow", part % 2 == 0 ? left_out : put_back));
    }
    EXPECT_LT(mean_rms_px(poses), 1);
}

}  // namespace
}  // namespace pursuit::tracker
