// SPDX-License-Identifier: Apache-2.0
// Sensor, tracker and recorder as processes: a tracker that hears the replay of a recording gives
// the recorded poses again, bit for bit.
#include <fstream>

#include "tests/system/recorder_fixture.hpp"

namespace pursuit::testing {
namespace {

using namespace std::chrono_literals;

class SamePoses : public RecorderTest {
 protected:
    std::unique_ptr<ChildProcess> service(const std::string& name,
                                          std::vector<std::string> settings) {
        settings.push_back("dds.loopback_only=true");
        settings.push_back("dds.domain=" + std::to_string(domain_.settings().domain()));
        std::vector<std::string> arguments;
        for (const auto& setting : settings) {
            arguments.insert(arguments.end(), {"--set", setting});
        }
        return std::make_unique<ChildProcess>(name, arguments, path("log-" + name));
    }

    void call(v1::TrackerRequest request) {
        const auto reply = client_->call(request, 5s);
        ASSERT_TRUE(reply) << reply.error().message;
        EXPECT_EQ(reply->outcome().code(), v1::STATUS_OK) << reply->outcome().message().to_string();
        std::printf("a call holds from %lld us\n",
                    static_cast<long long>(reply->effective_time_us()));
    }

    v1::TrackerRequest register_star(const char* name, double x_px, double y_px) {
        v1::RegisterModel model;
        model.name(name);
        model.transform(v1::TRANSFORM_SIMILARITY);
        model.start().x_px(x_px);
        model.start().y_px(y_px);
        model.start().a00(1);
        model.start().a11(1);
        std::ifstream csv(path("models/model_star.csv"));
        std::string line;
        std::getline(csv, line);
        while (std::getline(csv, line)) {
            v1::ModelPoint point;
            float x = 0;
            float y = 0;
            EXPECT_EQ(std::sscanf(line.c_str(), "%f,%f", &x, &y), 2) << line;
            point.x_px(x);
            point.y_px(y);
            model.points().push_back(point);
        }
        v1::TrackerRequest request;
        request.call().register_model(model);
        return request;
    }

    /// Of each object its poses in turn; host time, stream and sequence set aside.
    static std::map<std::uint32_t, std::vector<recorder::Payload>> poses(const std::string& file) {
        std::map<std::uint32_t, std::vector<recorder::Payload>> found;
        for (const auto& payload : read_recording(file).payloads(topic::poses)) {
            auto pose = deserialized<v1::ObjectPose>(payload);
            pose.host_time_ns(0);
            pose.stream_id(0);
            pose.sequence_number(0);
            found[pose.object_id()].push_back(serialized(pose));
        }
        return found;
    }

    /// Replays run.mcap to a fresh tracker; the poses it gives.
    std::map<std::uint32_t, std::vector<recorder::Payload>> replayed(const std::string& rate) {
        const auto output = path("replay-at-" + rate + ".mcap");
        auto recording = recorder({"output=" + output});
        auto tracker = service("pursuit-tracker", {});
        auto replay =
            recorder({"replay=" + path("run.mcap"), "rate=" + rate, "wait_for_subscribers=2"});
        EXPECT_EQ(replay->wait(), 0) << replay->log();
        std::this_thread::sleep_for(500ms);
        tracker->stop();
        recording->stop();
        return poses(output);
    }

    std::unique_ptr<RequestClient<v1::TrackerRequest, v1::TrackerReply>> client_;
};

TEST_F(SamePoses, come_from_the_replay_of_a_recording) {
    ChildProcess simulation(
        "pursuitctl",
        {"simulate", "star_670rpm", "--seed", "3", "--duration", "1", "--events", path("star.dat"),
         "--truth", path("truth.csv"), "--models", path("models")},
        path("log-simulate"));
    ASSERT_EQ(simulation.wait(), 0) << simulation.log();

    auto recording = recorder({"output=" + path("run.mcap")});
    auto tracker = service("pursuit-tracker", {});
    auto client = RequestClient<v1::TrackerRequest, v1::TrackerReply>::create(
        *participant_, topic::tracker_request, topic::tracker_reply, "");
    ASSERT_TRUE(client);
    client_ = std::move(*client);
    // The tracker and the recorder.
    ASSERT_TRUE(eventually([&] { return client_->heard_by() == 2; }));
    std::this_thread::sleep_for(500ms);
    call(register_star("before", 174, 134));
    auto sensor =
        service("pursuit-sensor", {"recording=" + path("star.dat"), "wait_for_subscribers=3"});
    std::this_thread::sleep_for(1s);
    // With the third subscriber it begins; the other two have settled meanwhile.
    auto reader =
        Reader<v1::EventPacket>::create(*participant_, topic::events, [](auto&, auto&) {});
    ASSERT_TRUE(reader);
    ASSERT_TRUE(eventually([&] { return (*reader)->matched() > 0; }));
    std::this_thread::sleep_for(300ms);
    call(register_star("during", 170, 130));
    std::this_thread::sleep_for(100ms);
    v1::SetPose set;
    set.name("before");
    set.pose().x_px(172.5);
    set.pose().y_px(133.25);
    set.pose().a00(1);
    set.pose().a11(1);
    v1::TrackerRequest request;
    request.call().set_pose(set);
    call(request);
    std::this_thread::sleep_for(100ms);
    v1::ModelName name;
    name.name("during");
    v1::TrackerRequest remove;
    remove.call().remove_model(name);
    call(remove);
    EXPECT_EQ(sensor->wait(), 0) << sensor->log();
    std::this_thread::sleep_for(500ms);
    tracker->stop();
    recording->stop();
    reader->reset();

    const auto run = read_recording(path("run.mcap"));
    EXPECT_EQ(run.payloads(topic::tracker_request).size(), 4U);
    EXPECT_EQ(run.payloads(topic::tracker_reply).size(), 4U);
    const auto live = poses(path("run.mcap"));
    ASSERT_EQ(live.size(), 2U);
    for (const auto* rate : {"1", "0"}) {
        const auto again = replayed(rate);
        for (const auto& [object_id, expected] : live) {
            const auto found = again.find(object_id);
            ASSERT_NE(found, again.end()) << "object " << object_id << " at rate " << rate;
            EXPECT_TRUE(found->second == expected)
                << "object " << object_id << " at rate " << rate << ": " << found->second.size()
                << " poses for " << expected.size();
            std::printf("object %u at rate %s: %zu poses, the same bit for bit\n", object_id, rate,
                        expected.size());
        }
        EXPECT_EQ(again.size(), live.size());
    }
}

}  // namespace
}  // namespace pursuit::testing
