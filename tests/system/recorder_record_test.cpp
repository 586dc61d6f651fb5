// SPDX-License-Identifier: Apache-2.0
// The real recorder, fed over loopback: what is in its file is what was sent.
#include <sys/mount.h>

#include <algorithm>
#include <fstream>
#include <future>

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
        const bool matched = eventually([&] {
            return events_->matched() == 1 && poses_->matched() == 1 && requests_->matched() == 1;
        });
        // The readers may know of the writers a little later than the other way round.
        std::this_thread::sleep_for(300ms);
        return matched;
    }
    bool all_acknowledged() {
        return events_->wait_acknowledged(5s) && poses_->wait_acknowledged(5s) &&
               requests_->wait_acknowledged(5s);
    }
    v1::RecorderStatus status() {
        auto client = RequestClient<v1::RecorderRequest, v1::RecorderReply>::create(
            *participant_, topic::recorder_request, topic::recorder_reply, "");
        v1::RecorderRequest request;
        request.call().get_status({});
        const auto reply = (*client)->call(request, 5s);
        EXPECT_TRUE(reply) << reply.error().message;
        return reply ? reply->result().get_status() : v1::RecorderStatus();
    }
    void new_file() {
        auto client = RequestClient<v1::RecorderRequest, v1::RecorderReply>::create(
            *participant_, topic::recorder_request, topic::recorder_reply, "");
        v1::RecorderRequest request;
        request.call().new_file({});
        const auto reply = (*client)->call(request, 5s);
        ASSERT_TRUE(reply) << reply.error().message;
        EXPECT_EQ(reply->outcome().code(), v1::STATUS_OK);
    }
    /// Packets first … first+count-1, one a millisecond; the payloads sent.
    std::vector<recorder::Payload> send_packets(std::uint64_t first, std::uint64_t count,
                                                std::uint32_t events = 200) {
        std::vector<recorder::Payload> sent;
        for (auto i = first; i < first + count; ++i) {
            sent.push_back(serialized(packet_number(i, 77, events)));
            EXPECT_TRUE(events_->write(sent.back(), -1, {}));
            std::this_thread::sleep_for(1ms);
        }
        return sent;
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
    EXPECT_TRUE(all_acknowledged());
    const auto took = process->stop();
    EXPECT_EQ(process->wait(), 0) << process->log();
    EXPECT_LT(took, 2s);

    const auto file = read_recording(path("run.mcap"));
    EXPECT_EQ(file.condition, Condition::closed) << file.error;
    for (const auto& [topic, payloads] : sent) {
        EXPECT_TRUE(file.payloads(topic) == payloads)
            << topic << ": " << file.payloads(topic).size() << " of " << payloads.size();
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

TEST_F(Recorder, that_is_killed_leaves_all_but_the_last_chunk) {
    auto process = recorder({"output=" + path("run.mcap"), "chunk_ms=200"});
    ASSERT_TRUE(connect()) << process->log();
    const auto sent = send_packets(0, 1000);
    process->signal(SIGKILL);
    process->wait();
    const auto file = read_recording(path("run.mcap"));
    const auto kept = file.payloads(topic::events);
    std::printf("killed after %zu packets at 1000/s: %zu are in the file, %s\n", sent.size(),
                kept.size(), std::string(name_of(file.condition)).c_str());
    EXPECT_THAT(file.condition, ::testing::AnyOf(Condition::not_closed, Condition::cut));
    // 200 ms of an open chunk, 50 ms until it is looked at, 100 ms for a busy host.
    ASSERT_GE(kept.size(), sent.size() - 350);
    EXPECT_TRUE(std::equal(kept.begin(), kept.end(), sent.begin()));
}

TEST_F(Recorder, begins_a_new_file_when_asked_and_never_replaces_one) {
    std::ofstream(path("run.mcap")) << "kept";
    auto process = recorder({"output=" + path("run.mcap")});
    ASSERT_TRUE(connect()) << process->log();
    auto sent = send_packets(0, 50);
    ASSERT_TRUE(all_acknowledged());
    new_file();
    const auto more = send_packets(50, 50);
    ASSERT_TRUE(all_acknowledged());
    EXPECT_EQ(status().file().to_string(), path("run-2.mcap"));
    process->stop();
    EXPECT_EQ(std::filesystem::file_size(path("run.mcap")), 4U);
    auto kept = read_recording(path("run-1.mcap")).payloads(topic::events);
    const auto second = read_recording(path("run-2.mcap"));
    EXPECT_EQ(second.condition, Condition::closed) << second.error;
    for (const auto& payload : second.payloads(topic::events)) kept.push_back(payload);
    sent.insert(sent.end(), more.begin(), more.end());
    EXPECT_TRUE(kept == sent) << kept.size() << " of " << sent.size();
}

TEST_F(Recorder, begins_a_later_file_with_the_models_of_the_trackers_that_are_still_there) {
    auto process = recorder({"output=" + path("run.mcap")});
    const auto model_of = [](std::uint32_t sensor_id) {
        v1::RegisteredModel model;
        model.sensor_id(sensor_id);
        model.object_id(1);
        model.registered(true);
        return serialized(model);
    };
    auto stays = raw_writer(topic::models);
    auto ends = raw_writer(topic::models);
    ASSERT_TRUE(eventually([&] { return stays->matched() == 1 && ends->matched() == 1; }))
        << process->log();
    for (auto payload = model_of(1); auto* writer : {stays.get(), ends.get()}) {
        EXPECT_TRUE(writer->write(payload, -1, {}));
        EXPECT_TRUE(writer->wait_acknowledged(5s));
        payload = model_of(2);
    }
    new_file();
    ends.reset();
    std::this_thread::sleep_for(300ms);
    new_file();
    process->stop();
    using Models = std::vector<recorder::Payload>;
    const Models all{model_of(1), model_of(2)};
    auto begun_with = read_recording(path("run-1.mcap")).payloads(topic::models);
    std::sort(begun_with.begin(), begun_with.end());
    EXPECT_EQ(begun_with, all);
    EXPECT_EQ(read_recording(path("run-2.mcap")).payloads(topic::models), Models{model_of(1)});
}

TEST_F(Recorder, that_ends_gives_who_reads_its_status_time_for_the_last_one) {
    auto process = recorder({"output=" + path("run.mcap")});
    // A reader that is busy with the first status that it hears once the recorder is to end.
    std::promise<void> ended;
    auto over = ended.get_future().share();
    std::atomic<bool> ending{false};
    auto reader = Reader<v1::RecorderStatus>::create(*participant_, topic::recorder_status,
                                                     [&](auto&, auto&) {
                                                         if (ending.load()) over.wait_for(5s);
                                                     });
    ASSERT_TRUE(eventually([&] { return (*reader)->matched() == 1; })) << process->log();
    std::this_thread::sleep_for(300ms);
    ending.store(true);
    const auto took = process->stop();
    ended.set_value();
    EXPECT_GE(took, 200ms);
    EXPECT_LT(took, 2s);
    EXPECT_EQ(process->wait(), 0) << process->log();
}

TEST_F(Recorder, counts_the_calls_and_replies_that_it_lost) {
    auto process = recorder({"output=" + path("run.mcap")});
    EXPECT_TRUE(connect()) << process->log();
    std::vector<std::string> none_lost;
    for (const auto& cause : status().dropped_by()) {
        if (cause.count() == 0) none_lost.push_back(cause.name().to_string());
    }
    EXPECT_THAT(none_lost,
                ::testing::IsSupersetOf({"requests.not_taken", "writes.replies_failed"}));
}

TEST_F(Recorder, on_a_full_disk_says_so_goes_on_and_records_again_when_there_is_room) {
    const auto disk = path("disk");
    std::filesystem::create_directory(disk);
    if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=1m") != 0) {
        GTEST_SKIP() << "a small file system cannot be mounted without being root";
    }
    {
        auto process =
            recorder({"output=" + disk + "/run.mcap", "compression=NONE", "chunk_bytes=65536"});
        EXPECT_TRUE(connect()) << process->log();
        send_packets(0, 400, 500);  // 1.6 MB
        EXPECT_TRUE(eventually([&] { return status().health().state() == v1::SERVICE_FAULT; }));
        const auto full = status();
        EXPECT_THAT(full.health().last_error().to_string(),
                    ::testing::HasSubstr("No space left on device"));
        send_packets(400, 50, 500);
        EXPECT_TRUE(all_acknowledged());
        EXPECT_TRUE(eventually(
            [&] { return status().messages_dropped() >= full.messages_dropped() + 50; }));
        EXPECT_TRUE(process->running());
        EXPECT_GT(read_recording(disk + "/run.mcap").payloads(topic::events).size(), 100U);

        std::filesystem::remove(disk + "/run.mcap");
        EXPECT_TRUE(eventually([&] { return status().health().state() == v1::SERVICE_RUNNING; }));
        const auto sent = send_packets(450, 20);
        EXPECT_TRUE(all_acknowledged());
        const std::string file = status().file().to_string();
        EXPECT_LT(process->stop(), 2s);
        EXPECT_EQ(process->wait(), 0) << process->log();
        EXPECT_TRUE(read_recording(file).payloads(topic::events) == sent);
    }
    EXPECT_EQ(::umount(disk.c_str()), 0);
}

TEST_F(Recorder, that_finds_the_disk_full_at_its_start_waits_for_room_and_stopped_so_has_failed) {
    const auto disk = path("disk");
    std::filesystem::create_directory(disk);
    if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=64k") != 0) {
        GTEST_SKIP() << "a small file system cannot be mounted without being root";
    }
    std::ofstream(disk + "/other") << std::string(100'000, ' ');
    {
        auto process = recorder({"output=" + disk + "/run.mcap"});
        EXPECT_TRUE(eventually([&] { return status().health().state() == v1::SERVICE_FAULT; }));
        EXPECT_LT(process->stop(), 2s);
        EXPECT_EQ(process->wait(), 1) << process->log();
    }
    {
        auto process = recorder({"output=" + disk + "/run.mcap"});
        EXPECT_TRUE(eventually([&] { return status().health().state() == v1::SERVICE_FAULT; }));
        std::filesystem::remove(disk + "/other");
        EXPECT_TRUE(eventually([&] { return status().health().state() == v1::SERVICE_RUNNING; }));
        EXPECT_LT(process->stop(), 2s);
        EXPECT_EQ(process->wait(), 0) << process->log();
    }
    EXPECT_EQ(::umount(disk.c_str()), 0);
}

TEST_F(Recorder, that_stands_still_costs_the_tracker_and_the_sensor_nothing) {
    auto process = recorder({"output=" + path("run.mcap")});
    ASSERT_TRUE(connect()) << process->log();
    // A reader as the tracker has it, which notes how old each packet is when it comes.
    auto reading = Participant::create(domain_.settings(), "tracker", "");
    std::mutex mutex;
    std::vector<double> latency_us;
    const auto now_ns = [] { return std::chrono::steady_clock::now().time_since_epoch().count(); };
    auto reader = Reader<v1::EventPacket>::create(**reading, topic::events, [&](auto& p, auto&) {
        const std::scoped_lock lock(mutex);
        latency_us.push_back(static_cast<double>(now_ns() - p.host_time_ns()) * 1e-3);
    });
    ASSERT_TRUE(eventually([&] { return events_->matched() == 2; }));
    std::this_thread::sleep_for(300ms);

    // 1000 packets of 2000 events in each second.
    std::uint64_t number = 0;
    const auto second = [&](const char* what) {
        {
            const std::scoped_lock lock(mutex);
            latency_us.clear();
        }
        std::vector<double> write_us;
        const auto begin = std::chrono::steady_clock::now();
        auto packet = packet_number(0, 77, 2000);
        for (int i = 0; i < 1000; ++i) {
            std::this_thread::sleep_until(begin + i * 1ms);
            packet.sequence_number(number++);
            packet.host_time_ns(now_ns());
            auto payload = serialized(packet);
            const auto before = now_ns();
            EXPECT_TRUE(events_->write(payload, -1, {}));
            write_us.push_back(static_cast<double>(now_ns() - before) * 1e-3);
        }
        EXPECT_TRUE(eventually([&] {
            const std::scoped_lock lock(mutex);
            return latency_us.size() >= 1000;
        }));
        const std::scoped_lock lock(mutex);
        EXPECT_EQ(latency_us.size(), 1000U) << what;
        std::sort(latency_us.begin(), latency_us.end());
        std::sort(write_us.begin(), write_us.end());
        std::printf("%-26s reader p50/p99/max %5.0f %6.0f %6.0f us, write %5.0f %6.0f %6.0f us\n",
                    what, latency_us[500], latency_us[990], latency_us.back(), write_us[500],
                    write_us[990], write_us.back());
        return latency_us[990];
    };
    second("warming up");
    const double running_us = second("recorder runs");
    process->signal(SIGSTOP);
    const double stopped_us = second("recorder stands still");
    process->signal(SIGCONT);
    second("recorder catches up");
    const double again_us = second("recorder runs again");
    // A stopped reader that the writer waited for would cost a heartbeat, 20 ms, or far more.
    EXPECT_LT(stopped_us, std::max(running_us, again_us) + 10'000);

    // What was missed is known.
    const auto after = status();
    std::uint64_t lost = 0;
    for (const auto& topic : after.topics()) {
        if (topic.topic().to_string() == topic::events) lost = topic.lost();
    }
    process->stop();
    const auto kept = read_recording(path("run.mcap")).payloads(topic::events).size();
    std::printf("sent %llu, in the file %zu, counted as lost %llu, gaps %llu\n",
                static_cast<unsigned long long>(number), kept,
                static_cast<unsigned long long>(lost),
                static_cast<unsigned long long>(after.gaps()));
    EXPECT_EQ(kept + lost, number);
    EXPECT_EQ(after.gaps() > 0, lost > 0);
}

}  // namespace
}  // namespace pursuit::testing
