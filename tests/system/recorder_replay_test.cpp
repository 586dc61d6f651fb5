// SPDX-License-Identifier: Apache-2.0
// The real recorder replays recordings that the test has written, to a tracker that the test plays.
#include "services/recorder/packet_fields.hpp"
#include "tests/system/played_tracker.hpp"
#include "tests/system/recorder_fixture.hpp"
#include "tests/system/recording_builder.hpp"

namespace pursuit::testing {
namespace {

using namespace std::chrono_literals;
using recorder::PacketFields;
using recorder::Payload;

v1::TrackerRequest register_call(const std::string& name) {
    v1::RegisterModel model;
    model.name(name);
    model.points().resize(3);
    v1::TrackerRequest request;
    request.call().register_model(model);
    return request;
}

v1::TrackerRequest remove_call(const std::string& name) {
    v1::ModelName model;
    model.name(name);
    v1::TrackerRequest request;
    request.call().remove_model(model);
    return request;
}

class Replay : public RecorderTest {};

TEST_F(Replay, repeats_the_packets_but_for_the_three_fields_that_are_new) {
    RecordingBuilder recording(path("run.mcap"), {topic::events});
    recording.add_packets(300);
    recording.close();
    PlayedTracker tracker(*participant_);
    auto process = recorder({"replay=" + path("run.mcap")});
    EXPECT_EQ(process->wait(), 0) << process->log();

    const auto heard = tracker.packets();
    ASSERT_EQ(heard.size(), 300U);
    recorder::Guid writer;
    writer.fill(0x50);
    std::uint64_t stream_id = 0;
    std::int64_t last_host_ns = 0;
    for (std::size_t i = 0; i < heard.size(); ++i) {
        auto expected = serialized(packet_number(i, 77));
        const auto was = PacketFields::of(expected);
        const auto now = PacketFields::of(heard[i].packet);
        ASSERT_TRUE(now);
        if (i == 0) stream_id = now->stream_id();
        EXPECT_NE(now->stream_id(), 77U);
        EXPECT_EQ(now->stream_id(), stream_id);
        EXPECT_GT(now->host_time_ns(), last_host_ns);
        last_host_ns = now->host_time_ns();
        EXPECT_EQ(now->recorded_host_time_ns(), was->host_time_ns());
        auto given = heard[i].packet;
        const Payload original = expected;
        const auto fields = *PacketFields::of(original);
        for (auto* payload : {&expected, &given}) {
            fields.set_stream_id(*payload, 0);
            fields.set_host_time_ns(*payload, 0);
            fields.set_recorded_host_time_ns(*payload, 0);
        }
        EXPECT_EQ(given, expected) << "packet " << i;
        const auto source_ns =
            RecordingBuilder::start_ns + static_cast<std::int64_t>(i) * 1'000'000 - 1000;
        EXPECT_NEAR(static_cast<double>(heard[i].source_time_ns - source_ns), 0, 1);
        EXPECT_EQ(heard[i].original, writer);
    }
}

TEST_F(Replay, makes_each_call_before_the_packet_that_reaches_its_time) {
    RecordingBuilder recording(path("run.mcap"),
                               {topic::events, topic::tracker_request, topic::tracker_reply});
    recording.add_call(0, register_call("first"), 0);
    recording.add_packets(100);  // packet i holds i ms to i ms + 199 us
    recording.add_call(50, register_call("second"), 40'100);
    recording.add_call(60, remove_call("refused"), 0, v1::STATUS_NOT_FOUND);
    recording.add_call(95, remove_call("first"), 40'200);
    recording.add_call(98, remove_call("second"), 1'000'000);
    recording.close();
    PlayedTracker tracker(*participant_);
    auto process = recorder({"replay=" + path("run.mcap"), "rate=0"});
    EXPECT_EQ(process->wait(), 0) << process->log();

    std::vector<std::string> order;
    std::size_t packets = 0;
    for (const auto& one : tracker.heard()) {
        if (!one.request) {
            ++packets;
            continue;
        }
        const auto& call = one.request->call();
        const bool registers = call._d() == v1::TRACKER_REGISTER_MODEL;
        if (registers) {
            EXPECT_EQ(call.register_model().object_id(), 7U);
        }
        order.push_back((registers ? "+" + call.register_model().name().to_string()
                                   : "-" + call.remove_model().name().to_string()) +
                        " at " + std::to_string(one.request->apply_at_us()) + " after " +
                        std::to_string(packets));
    }
    EXPECT_THAT(order,
                ::testing::ElementsAre("+first at 0 after 0", "+second at 40100 after 40",
                                       "-first at 40200 after 41", "-second at 1000000 after 100"));
    EXPECT_EQ(packets, 100U);
}

TEST_F(Replay, brings_about_what_held_before_the_recording_began) {
    RecordingBuilder recording(path("run.mcap"),
                               {topic::events, topic::models, topic::tracker_settings});
    v1::TrackerSettings settings;
    settings.instance("default");
    settings.sensor_id(1);
    settings.strategy(v1::STRATEGY_WEIGHTED);
    v1::NamedValue gain;
    gain.name("gate_px");
    gain.value(6);
    settings.parameters().push_back(gain);
    v1::RegisteredModel model;
    model.sensor_id(1);
    model.object_id(3);
    model.registered(true);
    model.name("car");
    model.transform(v1::TRANSFORM_SIMILARITY);
    model.start().x_px(12.5);
    model.parameters().push_back(gain);
    model.points().resize(2);
    recording.add(topic::models, 0, serialized(model));
    recording.add(topic::tracker_settings, 0, serialized(settings));
    recording.add_packets(10);
    recording.close();
    PlayedTracker tracker(*participant_);
    auto process = recorder({"replay=" + path("run.mcap")});
    EXPECT_EQ(process->wait(), 0) << process->log();

    const auto heard = tracker.heard();
    ASSERT_EQ(heard.size(), 13U);
    ASSERT_TRUE(heard[0].request && heard[1].request && heard[2].request);
    EXPECT_EQ(heard[0].request->call().set_occlusion_strategy().strategy(), v1::STRATEGY_WEIGHTED);
    EXPECT_EQ(heard[1].request->call().set_parameters().parameters().at(0).value(), 6);
    const auto& call = heard[2].request->call().register_model();
    EXPECT_EQ(call.object_id(), 3U);
    EXPECT_EQ(call.name().to_string(), "car");
    EXPECT_EQ(call.transform(), v1::TRANSFORM_SIMILARITY);
    EXPECT_EQ(call.start().x_px(), 12.5);
    EXPECT_EQ(call.points().size(), 2U);
    EXPECT_EQ(call.parameters().size(), 1U);
}

TEST_F(Replay, names_a_call_that_is_refused_and_fails_at_the_end) {
    RecordingBuilder recording(path("run.mcap"),
                               {topic::events, topic::tracker_request, topic::tracker_reply});
    recording.add_call(0, register_call("car"), 5000);
    recording.add_packets(20);
    recording.close();
    PlayedTracker tracker(*participant_, v1::STATUS_LIMIT_EXCEEDED);
    auto process = recorder({"replay=" + path("run.mcap")});
    EXPECT_EQ(process->wait(), 1);
    EXPECT_THAT(process->log(), ::testing::HasSubstr(
                                    "register model car at 5000 us: refused: because of the test"));
    EXPECT_EQ(tracker.packets().size(), 20U);
}

TEST_F(Replay, of_a_damaged_file_sends_what_is_good_and_fails_at_the_end) {
    RecordingBuilder recording(path("run.mcap"), {topic::events});
    recording.add_packets(2000);
    recording.close();
    const auto size = std::filesystem::file_size(path("run.mcap"));
    std::filesystem::resize_file(path("run.mcap"), size * 2 / 3);
    const auto good = read_recording(path("run.mcap")).messages.size();
    ASSERT_GT(good, 0U);
    ASSERT_LT(good, 2000U);
    PlayedTracker tracker(*participant_);
    auto process = recorder({"replay=" + path("run.mcap"), "rate=0"});
    EXPECT_EQ(process->wait(), 1);
    EXPECT_EQ(tracker.packets().size(), good);
    EXPECT_THAT(process->log(), ::testing::ContainsRegex("run.mcap: byte [0-9]+"));
}

TEST_F(Replay, as_fast_as_possible_loses_nothing) {
    constexpr int count = 5000;
    RecordingBuilder recording(path("run.mcap"), {topic::events});
    for (int i = 0; i < count; ++i) {
        recording.add(topic::events, i,
                      serialized(packet_number(static_cast<std::uint64_t>(i), 77, 1000)));
    }
    recording.close();
    PlayedTracker tracker(*participant_);
    const auto begin = std::chrono::steady_clock::now();
    auto process = recorder({"replay=" + path("run.mcap"), "rate=0"});
    EXPECT_EQ(process->wait(), 0) << process->log();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    EXPECT_EQ(tracker.packets().size(), static_cast<std::size_t>(count));
    std::printf("rate 0: %d packets of 1000 events in %.2f s, start and end included\n", count,
                took.count());
}

TEST_F(Replay, paces_by_log_time_and_obeys_its_requests) {
    RecordingBuilder recording(path("run.mcap"), {topic::events});
    recording.add_packets(3000);
    recording.close();
    PlayedTracker tracker(*participant_);
    auto process = recorder({"replay=" + path("run.mcap"), "rate=0.5"});
    auto client = RequestClient<v1::RecorderRequest, v1::RecorderReply>::create(
        *participant_, topic::recorder_request, topic::recorder_reply, "");
    const auto call = [&](auto fill) {
        v1::RecorderRequest request;
        fill(request.call());
        const auto reply = (*client)->call(request, 5s);
        EXPECT_TRUE(reply) << reply.error().message;
        return reply.value_or(v1::RecorderReply());
    };
    ASSERT_TRUE(eventually([&] { return tracker.packets().size() > 100; })) << process->log();
    EXPECT_EQ(call([](auto& c) { c.pause({}); }).outcome().code(), v1::STATUS_OK);
    std::this_thread::sleep_for(50ms);
    const auto paused_at = tracker.packets().size();
    std::this_thread::sleep_for(300ms);
    EXPECT_EQ(tracker.packets().size(), paused_at);
    EXPECT_EQ(call([](auto& c) { c.get_status({}); }).result().get_status().health().state(),
              v1::SERVICE_PAUSED);
    EXPECT_EQ(call([](auto& c) { c.new_file({}); }).outcome().code(), v1::STATUS_UNSUPPORTED);
    v1::ReplayRate rate;
    rate.rate(-1);
    const auto refused = call([&](auto& c) { c.set_rate(rate); });
    EXPECT_EQ(refused.outcome().code(), v1::STATUS_INVALID_ARGUMENT);
    EXPECT_THAT(refused.outcome().message().to_string(), ::testing::HasSubstr("rate is -1"));
    rate.rate(10);
    EXPECT_EQ(call([&](auto& c) { c.set_rate(rate); }).outcome().code(), v1::STATUS_OK);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(call([](auto& c) { c.resume({}); }).outcome().code(), v1::STATUS_OK);
    EXPECT_EQ(process->wait(), 0) << process->log();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    const double expected_s = (3000 - static_cast<double>(paused_at)) * 1e-3 / 10;
    EXPECT_GT(took.count(), expected_s * 0.9);
    EXPECT_EQ(tracker.packets().size(), 3000U);
    std::printf("rate 10: %.3f s for what takes %.3f s\n", took.count(), expected_s);
}

TEST_F(Replay, ends_within_two_seconds_while_it_waits_for_a_tracker) {
    RecordingBuilder recording(path("run.mcap"),
                               {topic::events, topic::tracker_request, topic::tracker_reply});
    recording.add_call(0, register_call("car"), 0);
    recording.add_packets(20);
    recording.close();
    auto process = recorder({"replay=" + path("run.mcap")});
    std::this_thread::sleep_for(1s);
    EXPECT_TRUE(process->running()) << process->log();
    EXPECT_LT(process->stop(), 2s);
}

}  // namespace
}  // namespace pursuit::testing
