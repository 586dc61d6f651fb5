// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core_thread.hpp"

#include <gtest/gtest.h>

#include <future>
#include <memory>

#include "tests/support/manual_clock.hpp"

namespace pursuit::tracker {
namespace {

/// A core thread that is not started yet.
struct Core {
    pursuit::test::ManualClock clock;
    TrackerQueue queue{4, 4};
    StoreWriter store{"", [](const std::string&) {}, [] {}};
    std::promise<void> replied;
    CoreThread thread{
        std::make_unique<TrackerSession>(
            Tracker::create({}).value(), ServiceIdentity{}, std::nullopt,
            std::vector<Registration>{}, clock,
            SessionOutputs{[](v1::ObjectPose&) { return true; },
                           [](v1::PoseTrack&) { return true; },
                           [](v1::RegisteredModel&) { return true; },
                           [](v1::TrackerSettings&) { return true; },
                           [](v1::RegisteredModel&) { return true; }, [](std::uint32_t) {},
                           [](const SessionFigures&) { return v1::TrackerStatus(); },
                           [](const std::string&) {}, [](const PoseRecord&) {},
                           [](const std::string&) {}, [] { return true; }}),
        queue, store, [this](const v1::RequestId&, v1::TrackerReply) { replied.set_value(); }};

    void ask(std::uint32_t times) {
        for (std::uint32_t i = 0; i < times; ++i) thread.figures();
    }
};

TEST(CoreThread, is_stalled_when_figures_were_asked_for_a_hundred_times_in_vain) {
    Core core;
    core.ask(CoreThread::most_unserved - 1);
    EXPECT_FALSE(core.thread.stalled());
    core.ask(1);
    EXPECT_TRUE(core.thread.stalled());
}

TEST(CoreThread, is_not_stalled_any_more_once_it_has_served_them) {
    Core core;
    core.ask(CoreThread::most_unserved);
    core.thread.start();
    v1::TrackerRequest request;
    request.call().get_status({});
    ASSERT_TRUE(core.queue.push_request(request));
    core.replied.get_future().wait();
    core.thread.stop();  // after the wishes, which are served before it looks whether it is to end
    EXPECT_FALSE(core.thread.stalled());
}

}  // namespace
}  // namespace pursuit::tracker
