// SPDX-License-Identifier: Apache-2.0
// Whether the covariance that comes with a pose is as large as the pose's error: the normalised
// error squared, whose mean is the number of the components where it is. What the filter adds to it
// for all that events have in common was tuned on eight scenes of discs, this one among them, with
// other seeds.
#include <Eigen/LU>
#include <cmath>

#include "tests/experiments/simulated.hpp"

namespace pursuit {
namespace {

using Vector = Eigen::Vector3d;

struct Sample {
    double pose = 0;      // normalised error squared of x, y, theta
    double velocity = 0;  // of vx, vy, omega
};

/// Takes the poses of one object and compares them with the truth at every step_us.
class Compare final : public tracker::PoseSink {
 public:
    Compare(const sensor::SceneSimulator& scene, std::int64_t from_us, std::int64_t step_us)
        : scene_(scene), next_us_(from_us), step_us_(step_us) {}

    void pose(const tracker::PoseRecord& record) override {
        if (record.t_us < next_us_) return;
        next_us_ += step_us_;
        const auto truth = scene_.truth(record.t_us).front();
        const auto before = scene_.truth(record.t_us - 500).front();
        const auto after = scene_.truth(record.t_us + 500).front();
        const double two_pi = 2 * std::acos(-1.0);
        const Vector error(record.pose.t_px.x() - truth.x_px, record.pose.t_px.y() - truth.y_px,
                           std::remainder(record.theta_rad - truth.theta_rad, two_pi));
        const Vector rate((after.x_px - before.x_px) * 1e3, (after.y_px - before.y_px) * 1e3,
                          std::remainder(after.theta_rad - before.theta_rad, two_pi) * 1e3);
        const Vector rate_error =
            Vector(record.velocity.vx_px_s, record.velocity.vy_px_s, record.velocity.omega_rad_s) -
            rate;
        Eigen::Matrix3d pose;
        Eigen::Matrix3d velocity;
        std::size_t of_row = 0;
        for (int row = 0; row < 3; ++row) {
            for (int column = row; column < 3; ++column) {
                const auto along = static_cast<std::size_t>(column - row);
                pose(row, column) = pose(column, row) = record.pose_covariance[of_row + along];
            }
            of_row += static_cast<std::size_t>(6 - row);
        }
        std::size_t i = 0;
        for (int row = 0; row < 3; ++row) {
            for (int column = row; column < 3; ++column, ++i) {
                velocity(row, column) = velocity(column, row) = record.velocity_covariance[i];
            }
        }
        samples.push_back(
            {error.dot(pose.inverse() * error), rate_error.dot(velocity.inverse() * rate_error)});
    }

    std::vector<Sample> samples;

 private:
    const sensor::SceneSimulator& scene_;
    std::int64_t next_us_;
    std::int64_t step_us_;
};

std::vector<Sample> followed(const char* scene_name, std::uint64_t seed) {
    const auto scene = sensor::load_scene(scene_name);
    EXPECT_TRUE(scene) << scene.error().message;
    sensor::SceneSimulator simulator(*scene, seed);
    auto registration = test::registration_of(simulator.models().front());
    registration.shape.edges.clear();
    auto tracker = tracker::Tracker::create({});
    tracker->begin_stream(simulator.geometry(), 1);
    EXPECT_TRUE(tracker->register_object(registration));
    Compare compare(simulator, 200'000, 20'000);
    test::follow(simulator, *tracker, 500'000, compare);
    return compare.samples;
}

TEST(Covariance, of_the_pose_is_as_large_as_its_errors_and_that_of_the_velocity_not_smaller) {
    Sample mean;
    double count = 0;
    for (std::uint64_t seed = 11; seed <= 18; ++seed) {
        Sample of_seed;
        const auto samples = followed("disc_arrow_670rpm", seed);
        for (const auto& sample : samples) {
            of_seed.pose += sample.pose / static_cast<double>(samples.size());
            of_seed.velocity += sample.velocity / static_cast<double>(samples.size());
        }
        std::printf("seed %llu: pose %.2f, velocity %.2f\n", static_cast<unsigned long long>(seed),
                    of_seed.pose, of_seed.velocity);
        mean.pose += of_seed.pose;
        mean.velocity += of_seed.velocity;
        ++count;
    }
    mean.pose /= count;
    mean.velocity /= count;
    std::printf("normalised error squared of 3: pose %.2f, velocity %.2f\n", mean.pose,
                mean.velocity);
    // Of 8 seeds with 15 poses each, were all of them independent, 95 % of the means would lie
    // within 2.6 and 3.5.
    EXPECT_GT(mean.pose, 2.6);
    EXPECT_LT(mean.pose, 3.5);
    // The filter is ready for a turn that this object never takes.
    EXPECT_LT(mean.velocity, 3.0);
    EXPECT_GT(mean.velocity, 0.1);
}

}  // namespace
}  // namespace pursuit
