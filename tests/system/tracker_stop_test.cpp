// SPDX-License-Identifier: Apache-2.0
// What a tracker that is stopped says last: all that came in is accounted for.
#include <gtest/gtest.h>

#include <mutex>

#include "services/common/reader.hpp"
#include "services/common/request_client.hpp"
#include "services/common/writer.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/system/child_process.hpp"
#include "tests/system/free_domain.hpp"

namespace pursuit::testing {
namespace {

using namespace std::chrono_literals;

TEST(TrackerStop, tells_last_that_it_has_finished_what_came_in_and_which_calls_are_dropped) {
    const test::TemporaryFolder folder;
    const FreeDomain domain;
    auto participant = std::move(*Participant::create(domain.settings(), "test", ""));
    std::mutex mutex;
    v1::TrackerStatus heard;
    const auto last = [&] {
        const std::scoped_lock lock(mutex);
        return heard;
    };
    const auto status = Reader<v1::TrackerStatus>::create(
        *participant, topic::tracker_status, [&](const v1::TrackerStatus& now, const auto&) {
            const std::scoped_lock lock(mutex);
            heard = now;
        });
    const auto events = Writer<v1::EventPacket>::create(*participant, topic::events);
    ASSERT_TRUE(status && events);
    ChildProcess tracker("pursuit-tracker",
                         {"--set", "dds.loopback_only=true", "--set",
                          "dds.domain=" + std::to_string(domain.settings().domain())},
                         folder.path("log"));
    auto client = std::move(*RequestClient<v1::TrackerRequest, v1::TrackerReply>::create(
        *participant, topic::tracker_request, topic::tracker_reply, ""));
    ASSERT_TRUE(client->wait_matched(10s));
    ASSERT_TRUE(eventually([&] { return (*events)->matched() == 1; }));
    v1::TrackerRequest later;
    later.apply_at_us(3'000'000);
    later.call().set_occlusion_strategy({});
    const auto accepted = client->call(later, 5s);
    ASSERT_TRUE(accepted);
    ASSERT_EQ(accepted->outcome().code(), v1::STATUS_OK) << accepted->outcome().message();

    v1::EventPacket packet;
    packet.sensor_id(1);
    packet.stream_id(8);
    packet.width(304);
    packet.height(240);
    packet.words().resize(100);
    for (std::uint64_t i = 1; i <= 50; ++i) {
        packet.sequence_number(i);
        packet.base_time_us(static_cast<std::int64_t>(i) * 1'000);
        ASSERT_TRUE((*events)->write(packet));
    }
    ASSERT_TRUE((*events)->wait_acknowledged({5, 0}));
    EXPECT_LT(tracker.stop(), 2s);
    EXPECT_EQ(tracker.wait(), 0) << tracker.log();
    ASSERT_TRUE(eventually([&] { return last().health().state() == v1::SERVICE_FINISHED; }));
    EXPECT_EQ(last().events_in(), 5'000U);
    EXPECT_EQ(last().requests(), 1U);
    EXPECT_EQ(last().health().errors(), 1U);
    EXPECT_NE(last().health().last_error().to_string().find("1 calls"), std::string::npos);
}

TEST(TrackerStop, by_a_signal_while_objects_are_restored_is_heard_before_they_are) {
    const test::TemporaryFolder folder;
    const FreeDomain domain;
    const auto model = folder.file("model_one.csv", "x_px,y_px\n-9,-9\n9,-9\n9,9\n-9,9\n");
    ChildProcess tracker(
        "pursuit-tracker",
        {"--set", "dds.loopback_only=true", "--set",
         "dds.domain=" + std::to_string(domain.settings().domain()), "--set", "model=" + model},
        folder.path("log"), [] {
            // It waits for the program, which blocks it too.
            sigset_t set;
            ::sigemptyset(&set);
            ::sigaddset(&set, SIGTERM);
            ::sigprocmask(SIG_BLOCK, &set, nullptr);
            ::raise(SIGTERM);
        });
    EXPECT_EQ(tracker.wait(), 0) << tracker.log();
    EXPECT_NE(tracker.log().find("stops on SIGTERM while it starts"), std::string::npos);
    EXPECT_EQ(tracker.log().find("ready"), std::string::npos) << tracker.log();
}

}  // namespace
}  // namespace pursuit::testing
