// SPDX-License-Identifier: Apache-2.0
// Sensor and tracker as processes: with pose_tracks every single update is on its topic.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <vector>

#include "services/common/reader.hpp"
#include "services/common/request_client.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/system/child_process.hpp"
#include "tests/system/free_domain.hpp"

namespace pursuit::testing {
namespace {

using namespace std::chrono_literals;

class PoseTracks : public ::testing::Test {
 protected:
    PoseTracks() {
        participant_ = std::move(*Participant::create(domain_.settings(), "test", ""));
        tracks_ = std::move(*Reader<v1::PoseTrack>::create(
            *participant_, topic::pose_tracks, [this](const v1::PoseTrack& track, const auto&) {
                const std::scoped_lock lock(mutex_);
                heard_.push_back(track);
            }));
        poses_ = std::move(*Reader<v1::ObjectPose>::create(
            *participant_, topic::poses, [this](const v1::ObjectPose& pose, const auto&) {
                const std::scoped_lock lock(mutex_);
                last_pose_ = pose;
                ++poses_heard_;
            }));
        client_ = std::move(*RequestClient<v1::TrackerRequest, v1::TrackerReply>::create(
            *participant_, topic::tracker_request, topic::tracker_reply, ""));
    }

    std::unique_ptr<ChildProcess> service(const std::string& name,
                                          std::vector<std::string> settings) {
        settings.insert(settings.end(),
                        {"dds.loopback_only=true",
                         "dds.domain=" + std::to_string(domain_.settings().domain())});
        std::vector<std::string> arguments;
        for (const auto& setting : settings) {
            arguments.insert(arguments.end(), {"--set", setting});
        }
        return std::make_unique<ChildProcess>(name, arguments, folder_.path("log-" + name));
    }

    void simulate_star() {
        ChildProcess simulation(
            "pursuitctl",
            {"simulate", "star_670rpm", "--duration", "0.2", "--events", folder_.path("star.dat"),
             "--truth", folder_.path("truth.csv"), "--models", folder_.path("models")},
            folder_.path("log-simulate"));
        ASSERT_EQ(simulation.wait(), 0) << simulation.log();
    }

    v1::TrackerStatus status() {
        v1::TrackerRequest request;
        request.call().get_status({});
        const auto reply = client_->call(request, 5s);
        return reply ? reply->result().get_status() : v1::TrackerStatus();
    }

    std::size_t updates() {
        const std::scoped_lock lock(mutex_);
        std::size_t count = 0;
        for (const auto& track : heard_) count += track.updates().size();
        return count;
    }

    std::uint64_t poses_heard() {
        const std::scoped_lock lock(mutex_);
        return poses_heard_;
    }

    test::TemporaryFolder folder_;
    FreeDomain domain_;
    std::unique_ptr<Participant> participant_;
    std::mutex mutex_;
    std::vector<v1::PoseTrack> heard_;
    std::unique_ptr<Reader<v1::PoseTrack>> tracks_;
    v1::ObjectPose last_pose_;
    std::uint64_t poses_heard_ = 0;
    std::unique_ptr<Reader<v1::ObjectPose>> poses_;
    std::unique_ptr<RequestClient<v1::TrackerRequest, v1::TrackerReply>> client_;
};

TEST_F(PoseTracks, have_every_update_of_an_object_in_the_order_of_time_and_are_numbered) {
    simulate_star();
    const auto tracker =
        service("pursuit-tracker",
                {"pose_tracks=true", "model=" + folder_.path("models/model_star.csv@174,134,0")});
    ASSERT_TRUE(eventually([&] {
        return tracks_->matched() == 1 && poses_->matched() == 1 && client_->heard_by() == 1;
    })) << tracker->log();
    // A reader hears of a writer before that hears of it. The tracker hears of these three in the
    // order in which they were made: who has its reply has its poses.
    ASSERT_TRUE(eventually([&] { return status().health().state() == v1::SERVICE_WAITING; }));
    const auto sensor = service("pursuit-sensor", {"recording=" + folder_.path("star.dat"),
                                                   "rate=0.25", "wait_for_subscribers=1"});
    ASSERT_EQ(sensor->wait(), 0) << sensor->log();
    ASSERT_TRUE(eventually([&] { return status().health().state() == v1::SERVICE_WAITING; }));
    const auto told = status();
    EXPECT_GT(told.events_used(), 100U);
    // One object: each event that is used is a step of it.
    EXPECT_TRUE(eventually([&] { return updates() == told.events_used(); }))
        << updates() << " of " << told.events_used();
    // After the last event the tracker may still say where the object is.
    EXPECT_TRUE(eventually([&] { return poses_heard() == status().poses_out(); }))
        << poses_heard() << " of " << status().poses_out() << ", before " << told.poses_out();
    const std::scoped_lock lock(mutex_);
    std::uint64_t number = 0;
    std::int64_t last_us = 0;
    for (const auto& track : heard_) {
        EXPECT_EQ(track.sequence_number(), ++number);
        EXPECT_EQ(track.object_id(), 1U);
        EXPECT_EQ(track.stream_id(), told.stream_id());
        for (const auto& update : track.updates()) {
            EXPECT_GE(update.t_us(), last_us);
            last_us = update.t_us();
        }
    }
    // They lead up to the poses.
    ASSERT_FALSE(heard_.empty());
    const auto& last = heard_.back().updates().back();
    EXPECT_LE(last_pose_.last_event_t_us(), last.t_us());
    EXPECT_NEAR(last.x_px(), last_pose_.x_px(), 1);
    EXPECT_NEAR(last.y_px(), last_pose_.y_px(), 1);
}

}  // namespace
}  // namespace pursuit::testing
