// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

constexpr Geometry crowd_sensor{1000, 600};
constexpr int crowd_size = 8;

std::string name_of(int i) { return "arrow_" + std::to_string(i); }

/// They go about in circles, far from each other.
Pose truth(int i, double t_us) {
    const double angle = 40e-6 * t_us + i;
    return {{140.0 + 240 * (i % 4) + 15 * std::cos(angle),
             150.0 + 300 * (i / 4) + 15 * std::sin(angle)},
            rotation(angle)};
}

/// What all of them make, and noise.
std::vector<Event> events() {
    std::vector<Event> all;
    for (int i = 0; i < crowd_size; ++i) {
        const auto pose_at = [&](double t_us) { return truth(i, t_us); };
        const auto of_one = outline_events(arrow(), pose_at, 0, 120'000, 40, 40, crowd_sensor,
                                           static_cast<std::uint32_t>(i));
        all.insert(all.end(), of_one.begin(), of_one.end());
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Event& l, const Event& r) { return l.t_us < r.t_us; });
    return all;
}

/// Of the objects from one to before another, all that the tracker says of the first.
std::vector<PoseRecord> followed(int from, int to, const Registration& like) {
    TrackerOptions options;
    options.max_poses_per_s = 1e6;
    Tracker tracker = Tracker::create(options).value();
    tracker.begin_stream(crowd_sensor, 1);
    // Searches take turns: who is searched for depends on who else there is.
    const std::vector<NamedValue> alone{{"checks_pose", 0}, {"let_go_sharpness", 0}};
    EXPECT_TRUE(tracker.set_parameters("", alone));
    for (int i = from; i < to; ++i) {
        Registration registration = like;
        registration.shape = arrow(name_of(i));
        registration.start.pose = truth(i, 0);
        tracker.register_object(registration).value();
    }
    Poses poses;
    tracker.process(events(), poses);
    std::vector<PoseRecord> of_first;
    for (const Poses::Row& row : poses.rows) {
        if (row.model == name_of(from)) of_first.push_back(row.record);
    }
    return of_first;
}

void expect_the_same_alone_and_among_others(const Registration& like) {
    for (const int i : {0, 3}) {
        const auto alone = followed(i, i + 1, like);
        const auto among = followed(i, i + 5, like);
        ASSERT_EQ(alone.size(), among.size());
        ASSERT_GT(alone.size(), 100U);
        for (std::size_t k = 0; k < alone.size(); ++k) {
            ASSERT_EQ(alone[k].pose.t_px, among[k].pose.t_px) << alone[k].t_us;
            ASSERT_EQ(alone[k].pose.a, among[k].pose.a) << alone[k].t_us;
        }
        EXPECT_NE(alone.back().pose.t_px, alone.front().pose.t_px);
    }
}

// Of few objects each is asked about all that comes in the cells around it, of many about what
// is as near as it reaches.

TEST(Crowd, moves_an_object_of_the_filter_as_if_it_were_alone) {
    Registration like;
    like.estimator = EstimatorKind::kalman;
    expect_the_same_alone_and_among_others(like);
}

TEST(Crowd, moves_an_object_of_the_descent_as_if_it_were_alone) {
    for (const TransformKind transform :
         {TransformKind::isometry, TransformKind::similarity, TransformKind::full_affine}) {
        Registration like;
        like.transform = transform;
        expect_the_same_alone_and_among_others(like);
    }
}

TEST(Crowd, moves_an_object_that_leaps_as_if_it_were_alone) {
    Registration like;
    // Each event takes it most of the way to itself: within a few it is many px elsewhere.
    like.parameters = {{"gate_px", 25}, {"gradient_position_gain", 0.45}};
    expect_the_same_alone_and_among_others(like);
}

}  // namespace
}  // namespace pursuit::tracker
