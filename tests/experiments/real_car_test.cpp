// SPDX-License-Identifier: Apache-2.0
// The recording of a real car that passes a static ATIS camera: models made of it at five instants,
// each followed until the car leaves the image, with the constants of the default preset.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "services/ctl/extraction/extract_model.hpp"
#include "services/ctl/offline_track.hpp"
#include "services/ctl/pose_csv.hpp"
#include "services/sensor/formats/formats.hpp"
#include "services/tracker/model_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_data.hpp"

namespace pursuit::ctl {
namespace {

/// The car's reference point at a time, found by registering frames of 20 ms around it.
struct Reference {
    std::int64_t t_us;
    Eigen::Vector2d point_px;
};

std::vector<Reference> read_reference(const std::string& path) {
    std::ifstream in(path);
    std::vector<Reference> reference;
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line.front() == '#') continue;
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream fields(line);
        double t_s = 0;
        Reference row{};
        fields >> t_s >> row.point_px.x() >> row.point_px.y();
        row.t_us = std::llround(t_s * 1e6);
        reference.push_back(row);
    }
    return reference;
}

Eigen::Vector2d reference_at(const std::vector<Reference>& reference, std::int64_t t_us) {
    for (std::size_t i = 1; i < reference.size(); ++i) {
        const auto& before = reference[i - 1];
        const auto& after = reference[i];
        if (t_us < before.t_us || t_us > after.t_us) continue;
        const double share =
            static_cast<double>(t_us - before.t_us) / static_cast<double>(after.t_us - before.t_us);
        return before.point_px + share * (after.point_px - before.point_px);
    }
    ADD_FAILURE() << "no reference at " << t_us;
    return Eigen::Vector2d::Zero();
}

constexpr std::int64_t window_us = 20'000;
constexpr std::int64_t end_us = 2'200'000;

class RealCar : public testing::Test {
 protected:
    /// rms distance, px, of the reference point that the poses carry to where it was.
    double follow(const std::string& events, const std::vector<Reference>& reference,
                  std::int64_t start_us, std::size_t points) {
        const auto middle_px = reference_at(reference, start_us + window_us / 2);
        Extraction extraction;
        extraction.name = "car";
        extraction.start_us = start_us;
        extraction.window_us = window_us;
        // The car reaches from 50 px behind the reference point to 88 px before it.
        extraction.x_px = std::max(0, static_cast<int>(middle_px.x()) - 60);
        extraction.y_px = static_cast<int>(middle_px.y()) - 26;
        extraction.width_px = 155;
        extraction.height_px = 52;
        extraction.points = points;
        auto recording = sensor::open_events(events);
        const auto extracted = extract_model(**recording, extraction);
        EXPECT_TRUE(extracted) << extracted.error().message;
        const auto model_path = folder_.path("car.model.textproto");
        EXPECT_TRUE(tracker::write_model_file(model_path, extracted->model));

        OfflineTrack task;
        task.events = events;
        task.models = {model_path};
        task.transform = tracker::TransformKind::similarity;
        task.range = {start_us + window_us, end_us};
        task.poses = folder_.path("poses.csv");
        const auto done = track_offline(task);
        EXPECT_TRUE(done) << done.error().message;
        const auto poses = read_pose_csv(task.poses);
        EXPECT_TRUE(poses) << poses.error().message;
        return rms_px(*poses, reference, middle_px - *extracted->model.origin_px,
                      start_us + window_us);
    }

    static double rms_px(const std::vector<PoseRow>& poses, const std::vector<Reference>& reference,
                         const Eigen::Vector2d& point_model, std::int64_t from_us) {
        double sum = 0;
        int count = 0;
        for (const auto& row : reference) {
            if (row.t_us < from_us || row.t_us > end_us) continue;
            const auto next = std::upper_bound(
                poses.begin(), poses.end(), row.t_us,
                [](std::int64_t t_us, const PoseRow& pose) { return t_us < pose.t_us; });
            if (next == poses.begin()) continue;
            const auto& pose = (next - 1)->pose;
            sum += (pose.t_px + pose.a * point_model - row.point_px).squaredNorm();
            ++count;
        }
        EXPECT_GE(count, 25);
        return std::sqrt(sum / std::max(1, count));
    }

    test::TemporaryFolder folder_;
};

TEST_F(RealCar, is_followed_by_models_made_at_five_instants) {
    PURSUIT_DATA_OR_SKIP(events, "car/car_atis_td.dat");
    PURSUIT_DATA_OR_SKIP(reference_path, "car/reference_pose_20ms.csv");
    const auto reference = read_reference(reference_path);
    ASSERT_GT(reference.size(), 30U);
    constexpr double most_px = 2;
    // The default number of points, and more.
    for (const std::size_t points : {300U, 400U}) {
        std::vector<double> errors_px;
        for (const std::int64_t start_us :
             {1'560'000, 1'580'000, 1'600'000, 1'620'000, 1'640'000}) {
            errors_px.push_back(follow(events, reference, start_us, points));
        }
        std::printf("%3zu points: rms", points);
        for (const double error_px : errors_px) std::printf(" %.2f", error_px);
        std::sort(errors_px.begin(), errors_px.end());
        std::printf(" px, median %.2f px\n", errors_px[2]);
        EXPECT_LE(errors_px[2], most_px) << points << " points";
    }
}

}  // namespace
}  // namespace pursuit::ctl
