// SPDX-License-Identifier: Apache-2.0
// Sensor, tracker and recorder as processes: a tracker that hears the replay of a recording gives
// the recorded poses again, bit for bit.
#include <atomic>
#include <fstream>
#include <set>

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

    /// Replays a recording to a fresh tracker; the recording of that.
    std::string replayed(const std::string& rate, const std::string& file = "run.mcap") {
        const auto output = path("replay-at-" + rate + ".mcap");
        auto recording = recorder({"output=" + output});
        auto tracker = service("pursuit-tracker", {});
        auto replay = recorder({"replay=" + path(file), "rate=" + rate, "wait_for_subscribers=2"});
        EXPECT_EQ(replay->wait(), 0) << replay->log();
        std::this_thread::sleep_for(500ms);
        tracker->stop();
        recording->stop();
        return output;
    }

    void simulate_star() {
        ChildProcess simulation(
            "pursuitctl",
            {"simulate", "star_670rpm", "--seed", "3", "--duration", "1", "--events",
             path("star.dat"), "--truth", path("truth.csv"), "--models", path("models")},
            path("log-simulate"));
        ASSERT_EQ(simulation.wait(), 0) << simulation.log();
    }

    /// Calls on the tracker, once it and the recorder hear them.
    void connect() {
        auto client = RequestClient<v1::TrackerRequest, v1::TrackerReply>::create(
            *participant_, topic::tracker_request, topic::tracker_reply, "");
        ASSERT_TRUE(client);
        client_ = std::move(*client);
        ASSERT_TRUE(eventually([&] { return client_->heard_by() == 2; }));
        std::this_thread::sleep_for(500ms);
    }

    std::unique_ptr<RequestClient<v1::TrackerRequest, v1::TrackerReply>> client_;
    std::atomic<std::int64_t> last_us_{0};  ///< Of the poses that the test hears.
};

TEST_F(SamePoses, come_from_the_replay_of_a_recording) {
    simulate_star();
    auto recording = recorder({"output=" + path("run.mcap")});
    auto tracker = service("pursuit-tracker", {});
    connect();
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
    // A client that has just come is answered twice.
    const auto replies = run.payloads(topic::tracker_reply);
    EXPECT_EQ(std::set(replies.begin(), replies.end()).size(), 4U);
    const auto live = poses(path("run.mcap"));
    ASSERT_EQ(live.size(), 2U);
    for (const auto* rate : {"1", "0"}) {
        const auto again = poses(replayed(rate));
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

TEST_F(SamePoses, come_near_in_the_replay_of_a_later_file_alone) {
    simulate_star();
    auto recording = recorder({"output=" + path("run.mcap")});
    auto tracker = service("pursuit-tracker", {});
    connect();
    call(register_star("star", 174, 134));
    auto sensor =
        service("pursuit-sensor", {"recording=" + path("star.dat"), "wait_for_subscribers=2"});
    auto poses = Reader<v1::ObjectPose>::create(
        *participant_, topic::poses, [&](v1::ObjectPose& pose, auto&) { last_us_ = pose.t_us(); });
    ASSERT_TRUE(eventually([&] { return last_us_ > 300'000; }));
    auto client = RequestClient<v1::RecorderRequest, v1::RecorderReply>::create(
        *participant_, topic::recorder_request, topic::recorder_reply, "");
    v1::RecorderRequest request;
    request.call().new_file({});
    const auto reply = (*client)->call(request, 5s);
    ASSERT_TRUE(reply) << reply.error().message;
    EXPECT_EQ(sensor->wait(), 0) << sensor->log();
    std::this_thread::sleep_for(500ms);
    tracker->stop();
    recording->stop();

    const auto last = [](const std::string& file) {
        const auto payloads = read_recording(file).payloads(topic::poses);
        EXPECT_FALSE(payloads.empty()) << file;
        return payloads.empty() ? v1::ObjectPose() : deserialized<v1::ObjectPose>(payloads.back());
    };
    const auto live = last(path("run-1.mcap"));
    const auto again = last(replayed("1", "run-1.mcap"));
    EXPECT_EQ(again.model().to_string(), "star");
    EXPECT_EQ(again.object_id(), live.object_id());
    EXPECT_EQ(again.t_us(), live.t_us());
    EXPECT_EQ(again.state(), v1::TRACK_TRACKING);
    EXPECT_NEAR(again.x_px(), live.x_px(), 1);
    EXPECT_NEAR(again.y_px(), live.y_px(), 1);
}

}  // namespace
}  // namespace pursuit::testing
