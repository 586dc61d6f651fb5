// SPDX-License-Identifier: Apache-2.0
// A program of its own, because it takes the place of the system's resolver.
#include <gtest/gtest.h>
#include <netdb.h>

#include <atomic>
#include <thread>

#include "services/sensor/live/live_connection.hpp"

namespace {

std::atomic<bool> asked{false};
std::atomic<bool> may_answer{false};

void set(std::atomic<bool>& flag) {
    flag = true;
    flag.notify_all();
}

}  // namespace

extern "C" int getaddrinfo(const char* /*host*/, const char* /*port*/, const addrinfo* /*wanted*/,
                           addrinfo** /*found*/) {
    set(asked);
    may_answer.wait(false);
    return EAI_NONAME;
}

namespace pursuit::sensor {
namespace {

TEST(ConnectLive, is_stopped_while_a_name_is_looked_up) {
    StopSignal stop;
    const auto address = parse_live_address("tcp://camera.example:7000");
    ASSERT_TRUE(address);
    std::string error;
    std::thread connecting([&] { error = connect_live(*address, stop).error().message; });
    asked.wait(false);
    stop.raise();
    connecting.join();  // not before the resolver answers, without a lookup that is left behind
    EXPECT_EQ(error, "tcp://camera.example:7000: stopped");
    set(may_answer);
    const StopSignal never;
    EXPECT_EQ(connect_live(*address, never).error().message,
              std::string("tcp://camera.example:7000: ") + ::gai_strerror(EAI_NONAME));
}

}  // namespace
}  // namespace pursuit::sensor
