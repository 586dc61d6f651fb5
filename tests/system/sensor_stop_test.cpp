// SPDX-License-Identifier: Apache-2.0
// What a sensor that is stopped says last: every event is accounted for, and its stream ends.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <mutex>

#include "services/common/reader.hpp"
#include "services/common/request_client.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/system/child_process.hpp"
#include "tests/system/free_domain.hpp"

namespace pursuit::testing {
namespace {

using namespace std::chrono_literals;

class SensorStop : public ::testing::Test {
 protected:
    SensorStop() {
        participant_ = std::move(*Participant::create(domain_.settings(), "test", ""));
        events_ = std::move(*Reader<v1::EventPacket>::create(
            *participant_, topic::events, [this](const v1::EventPacket& packet, const auto&) {
                const std::scoped_lock lock(mutex_);
                words_ += packet.words().size();
                ended_ = packet.end_of_stream();
                ++packets_;
            }));
        status_ = std::move(
            *Reader<v1::SensorStatus>::create(*participant_, topic::sensor_status,
                                              [this](const v1::SensorStatus& status, const auto&) {
                                                  const std::scoped_lock lock(mutex_);
                                                  last_ = status;
                                              }));
    }

    std::unique_ptr<ChildProcess> sensor(std::vector<std::string> settings) {
        settings.insert(settings.end(),
                        {"dds.loopback_only=true", "wait_for_subscribers=1",
                         "dds.domain=" + std::to_string(domain_.settings().domain())});
        std::vector<std::string> arguments;
        for (const auto& setting : settings) {
            arguments.insert(arguments.end(), {"--set", setting});
        }
        return std::make_unique<ChildProcess>("pursuit-sensor", arguments, folder_.path("log"));
    }

    std::uint64_t packets() {
        const std::scoped_lock lock(mutex_);
        return packets_;
    }

    v1::SensorStatus last() {
        const std::scoped_lock lock(mutex_);
        return last_;
    }

    static std::uint64_t unsent(v1::SensorStatus status) {
        for (auto& cause : status.dropped_by()) {
            if (cause.name().to_string() == "events.unsent_at_stop") return cause.count();
        }
        return 0;
    }

    /// What holds of every sensor that has ended.
    void expect_all_told() {
        ASSERT_TRUE(eventually([&] { return last().health().state() == v1::SERVICE_FINISHED; }));
        auto status = last();
        EXPECT_EQ(status.events_in(), status.events_out() + status.events_dropped());
        ASSERT_TRUE(eventually([&] {
            const std::scoped_lock lock(mutex_);
            return words_ == status.events_out() && packets_ == status.packets_out();
        })) << words_
            << " of " << status.events_out() << " events, " << packets_ << " of "
            << status.packets_out() << " packets";
        EXPECT_TRUE(ended_);
    }

    test::TemporaryFolder folder_;
    FreeDomain domain_;
    std::unique_ptr<Participant> participant_;
    std::mutex mutex_;
    std::uint64_t words_ = 0;
    std::uint64_t packets_ = 0;
    bool ended_ = false;
    v1::SensorStatus last_;
    std::unique_ptr<Reader<v1::EventPacket>> events_;
    std::unique_ptr<Reader<v1::SensorStatus>> status_;
};

TEST_F(SensorStop, within_a_scene_sends_what_it_was_filling_counts_the_rest_and_ends_the_stream) {
    const auto process = sensor({"scene=overtake", "rate=0.5", "packet_us=20000"});
    ASSERT_TRUE(eventually([&] { return packets() >= 5; }));
    EXPECT_LT(process->stop(), 2s);
    EXPECT_EQ(process->wait(), 0) << process->log();
    expect_all_told();
    EXPECT_GT(unsent(last()), 0U);
}

TEST_F(SensorStop, while_it_skips_to_where_its_range_begins_ends_at_once) {
    const auto scene = folder_.file("noise.scene.textproto",
                                    "name: 'noise' background_reflectance: 0.5\n"
                                    "sensor { width: 32 height: 32 noise_hz: 10 }\n");
    const auto process = sensor({"scene=" + scene, "start_s=5000000"});
    ASSERT_TRUE(eventually([&] { return last().health().state() == v1::SERVICE_RUNNING; }))
        << process->log();
    EXPECT_LT(process->stop(), 2s);
    EXPECT_EQ(process->wait(), 0) << process->log();
    expect_all_told();
}

TEST_F(SensorStop, while_a_live_source_is_paused_counts_what_waits) {
    const auto fifo = folder_.path("camera");
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    const auto process = sensor({"live=" + fifo, "live_format=evt2", "live_geometry=640x480"});
    const int file = ::open(fifo.c_str(), O_WRONLY);
    ASSERT_GE(file, 0);
    const auto write = [&](std::uint32_t high) {
        std::vector<std::uint32_t> words{8U << 28 | high};
        words.resize(1001, 1U << 28 | 5U << 11 | 7U);
        ASSERT_EQ(::write(file, words.data(), words.size() * 4),
                  static_cast<ssize_t>(words.size() * 4));
        ASSERT_TRUE(eventually([&] {
            int waiting = 0;
            return ::ioctl(file, FIONREAD, &waiting) == 0 && waiting == 0;
        }));
    };
    write(1000);
    ASSERT_TRUE(eventually([&] { return packets() >= 1; }));
    auto client = std::move(*RequestClient<v1::SensorRequest, v1::SensorReply>::create(
        *participant_, topic::sensor_request, topic::sensor_reply, "default"));
    v1::SensorRequest pause;
    pause.call().pause({});
    ASSERT_TRUE(client->call(pause, 5s));
    for (std::uint32_t i = 1; i <= 5; ++i) write(1000 + 1000 * i);
    EXPECT_LT(process->stop(), 2s);
    ::close(file);
    EXPECT_EQ(process->wait(), 0) << process->log();
    expect_all_told();
    EXPECT_EQ(last().events_in(), 6000U);
    EXPECT_GT(unsent(last()), 0U);
}

TEST_F(SensorStop, at_the_end_of_standard_input_waits_for_those_who_hear_it) {
    std::string words;
    for (std::uint32_t high = 1; high <= 2000; ++high) {
        const std::uint32_t pair[] = {8U << 28 | high * 100, 1U << 28 | 5U << 11 | 7U};
        words.append(reinterpret_cast<const char*>(pair), sizeof pair);
    }
    const auto path = folder_.file("events.raw", words);
    const auto domain = std::to_string(domain_.settings().domain());
    ChildProcess process("pursuit-sensor",
                         {"--set", "live=-", "--set", "live_format=evt2", "--set",
                          "live_geometry=640x480", "--set", "dds.loopback_only=true", "--set",
                          "wait_for_subscribers=1", "--set", "dds.domain=" + domain},
                         folder_.path("log"),
                         [&] { ::dup2(::open(path.c_str(), O_RDONLY), STDIN_FILENO); });
    EXPECT_EQ(process.wait(), 0) << process.log();
    expect_all_told();
    EXPECT_EQ(last().events_in(), 2000U);
    EXPECT_EQ(unsent(last()), 0U);
}

}  // namespace
}  // namespace pursuit::testing
