// SPDX-License-Identifier: Apache-2.0
// The real recorder, fed over loopback: what is in its file is what was sent.
#include "tests/system/recorder_fixture.hpp"

namespace pursuit::testing {
namespace {

using namespace std::chrono_literals;
using recorder::mcap::Condition;

v1::ObjectPose pose_number(std::uint64_t number) {
    v1::ObjectPose pose;
    pose.sensor_id(1);
    pose.object_id(static_cast<std::uint32_t>(1 + number % 3));
    pose.sequence_number(number / 3);
    pose.t_us(static_cast<std::int64_t>(number) * 1000);
    pose.model("car");
    pose.x_px(0.5 * static_cast<double>(number));
    return pose;
}

class Recorder : public RecorderTest {
 protected:
    /// Writers of three topics; true once the recorder hears all of them.
    bool connect() {
        events_ = raw_writer(topic::events);
        poses_ = raw_writer(topic::poses);
        requests_ = raw_writer(topic::tracker_request);
        return eventually([&] {
            return events_->matched() == 1 && poses_->matched() == 1 && requests_->matched() == 1;
        });
    }
    std::unique_ptr<recorder::RawWriter> events_;
    std::unique_ptr<recorder::RawWriter> poses_;
    std::unique_ptr<recorder::RawWriter> requests_;
};

TEST_F(Recorder, keeps_every_message_as_it_was_sent) {
    auto process = recorder({"output=" + path("run.mcap")});
    ASSERT_TRUE(connect()) << process->log();
    std::map<std::string, std::vector<recorder::Payload>> sent;
    for (std::uint64_t i = 0; i < 500; ++i) {
        const auto source_time_ns = static_cast<std::int64_t>(1'000'000'000 + i);
        const auto send = [&](const char* topic, auto& writer, recorder::Payload payload) {
            ASSERT_TRUE(writer->write(payload, source_time_ns, {}));
            sent[topic].push_back(std::move(payload));
        };
        send(topic::events, events_, serialized(packet_number(i, 77)));
        send(topic::poses, poses_, serialized(pose_number(i)));
        if (i % 50 == 0) {
            v1::TrackerRequest request;
            request.header().request_id().sequence_low(static_cast<std::uint32_t>(i));
            request.apply_at_us(static_cast<std::int64_t>(i));
            send(topic::tracker_request, requests_, serialized(request));
        }
        std::this_thread::sleep_for(1ms);
    }
    const auto took = process->stop();
    EXPECT_EQ(process->wait(), 0) << process->log();
    EXPECT_LT(took, 2s);

    const auto file = read_recording(path("run.mcap"));
    EXPECT_EQ(file.condition, Condition::closed) << file.error;
    for (const auto& [topic, payloads] : sent) {
        EXPECT_EQ(file.payloads(topic), payloads) << topic;
    }
    // Publish time is the writer's; reception is the host's clock.
    std::int64_t expected_ns = 1'000'000'000;
    for (const auto& message : file.messages) {
        if (message.channel.topic != topic::events) continue;
        EXPECT_NEAR(static_cast<double>(message.head.publish_time_ns - expected_ns), 0, 1);
        EXPECT_GT(message.head.log_time_ns, 1'700'000'000'000'000'000);
        ++expected_ns;
    }
}

}  // namespace
}  // namespace pursuit::testing
