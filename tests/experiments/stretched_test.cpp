// SPDX-License-Identifier: Apache-2.0
// An H before a tilting camera whose start is off by some pixels and by all of its shear: drawn out
// along its own bars by a third it fitted but for its ends, and was said to be there, for seconds.
// Of 400 such starts two went so.
#include <gtest/gtest.h>

#include <cmath>

#include "services/sensor/scene/scene_simulator.hpp"
#include "services/tracker/core/tracker.hpp"

namespace pursuit {
namespace {

struct Start {
    std::uint64_t seed;
    double x_px, y_px, theta_rad, scale;
};

/// Measures how far the shape's points are from where they are, once a start was to be mended.
class Error final : public tracker::PoseSink {
 public:
    Error(const sensor::SceneSimulator& scene, const tracker::Shape& shape)
        : scene_(scene), shape_(shape) {}

    void pose(const tracker::PoseRecord& record) override {
        if (record.t_us < 500'000) return;
        const auto truth = scene_.truth(record.t_us).front();
        Eigen::Matrix2d a;
        a << truth.a00, truth.a01, truth.a10, truth.a11;
        double sum = 0;
        for (const auto& point : shape_.points_px) {
            const Eigen::Vector2d m = point.cast<double>();
            const Eigen::Vector2d there = Eigen::Vector2d(truth.x_px, truth.y_px) + a * m;
            sum += (record.pose.t_px + record.pose.a * m - there).squaredNorm();
        }
        sum_px_ += std::sqrt(sum / static_cast<double>(shape_.points_px.size()));
        ++poses_;
    }
    [[nodiscard]] double mean_px() const { return sum_px_ / poses_; }

 private:
    const sensor::SceneSimulator& scene_;
    const tracker::Shape& shape_;
    double sum_px_ = 0;
    int poses_ = 0;
};

double mean_error_px(const Start& start) {
    const auto scene = sensor::load_scene("perspective_H");
    EXPECT_TRUE(scene) << scene.error().message;
    sensor::SceneSimulator simulator(*scene, start.seed);
    const auto& model = simulator.models().front();
    tracker::Registration registration;
    registration.shape.name = model.name;
    for (const auto& point : model.model.points) {
        registration.shape.points_px.emplace_back(static_cast<float>(point.x()),
                                                  static_cast<float>(point.y()));
    }
    for (const auto& [from, to] : model.model.edges) {
        registration.shape.edges.push_back(
            {static_cast<std::uint16_t>(from), static_cast<std::uint16_t>(to)});
    }
    registration.estimator = tracker::EstimatorKind::kalman;
    registration.transform = tracker::TransformKind::full_affine;
    registration.start.pose = tracker::pose_of(start.x_px, start.y_px, start.theta_rad);
    registration.start.pose.a *= start.scale;
    auto tracker = tracker::Tracker::create({});
    tracker->begin_stream(simulator.geometry(), 1);
    EXPECT_TRUE(tracker->register_object(registration));
    Error error(simulator, registration.shape);
    std::vector<Event> events;
    while (simulator.time_us() < 1'500'000 && simulator.next(10'000, events)) {
        tracker->process(events, error);
        events.clear();
    }
    return error.mean_px();
}

TEST(Stretched, an_h_that_was_drawn_out_along_its_bars_is_looked_for_and_found) {
    EXPECT_LT(mean_error_px({36, 172.189423, 122.097478, -0.833968, 0.811505}), 1);
    EXPECT_LT(mean_error_px({88, 161.156040, 119.637494, -2.891977, 0.789332}), 1);
}

}  // namespace
}  // namespace pursuit
