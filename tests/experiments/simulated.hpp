// SPDX-License-Identifier: Apache-2.0
// Following what a built-in scene shows, in the test's own process.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "services/sensor/scene/scene_simulator.hpp"
#include "services/tracker/core/tracker.hpp"

namespace pursuit::test {

/// A model of a scene for the filter, where the scene has it start.
inline tracker::Registration registration_of(const sensor::SceneModel& model) {
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
    registration.start.pose =
        tracker::pose_of(model.start.x_px, model.start.y_px, model.start.theta_rad);
    return registration;
}

/// How far the points of each object are from where they truly are: rms over the points, mean over
/// the poses from a time on.
class MeanErrors final : public tracker::PoseSink {
 public:
    MeanErrors(const sensor::SceneSimulator& scene, std::int64_t from_us)
        : scene_(scene), from_us_(from_us) {}

    void pose(const tracker::PoseRecord& record) override {
        if (record.t_us < from_us_) return;
        const auto truth = scene_.truth(record.t_us);
        for (std::size_t i = 0; i < truth.size(); ++i) {
            if (truth[i].model != record.model) continue;
            Eigen::Matrix2d a;
            a << truth[i].a00, truth[i].a01, truth[i].a10, truth[i].a11;
            double sum = 0;
            for (const auto& m : scene_.models()[i].model.points) {
                const Eigen::Vector2d there = Eigen::Vector2d(truth[i].x_px, truth[i].y_px) + a * m;
                sum += (record.pose.t_px + record.pose.a * m - there).squaredNorm();
            }
            auto& [sum_px, poses] = of_[std::string(record.model)];
            sum_px += std::sqrt(sum / static_cast<double>(scene_.models()[i].model.points.size()));
            ++poses;
        }
    }
    [[nodiscard]] double px(const std::string& model) const {
        const auto& [sum_px, poses] = of_.at(model);
        return sum_px / poses;
    }

 private:
    const sensor::SceneSimulator& scene_;
    std::int64_t from_us_;
    std::map<std::string, std::pair<double, int>> of_;
};

/// Hands the events of a scene until then to a tracker.
inline void follow(sensor::SceneSimulator& scene, tracker::Tracker& tracker, std::int64_t until_us,
                   tracker::PoseSink& poses) {
    std::vector<Event> events;
    while (scene.time_us() < until_us && scene.next(10'000, events)) {
        tracker.process(events, poses);
        events.clear();
    }
}

}  // namespace pursuit::test
