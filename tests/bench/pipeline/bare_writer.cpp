// SPDX-License-Identifier: Apache-2.0
// The other end of a bare hop: writes packets of a given size at a steady pace, each with the time
// at which it is handed to the middleware. The same topic, type and quality of service as the
// sensor's, and nothing else; an observer in a domain of their own receives them.
//
//   bare_writer DOMAIN WORDS PERIOD_US COUNT
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "services/common/clock.hpp"
#include "services/common/writer.hpp"

namespace pursuit {
namespace {

int run(std::uint32_t domain, std::size_t words, std::chrono::microseconds period, int count) {
    disk::Dds settings;
    settings.set_domain(domain);
    settings.set_loopback_only(true);
    auto participant = Participant::create(settings, "bare_writer", "");
    if (!participant) {
        std::fprintf(stderr, "bare_writer: %s\n", participant.error().message.c_str());
        return 1;
    }
    auto writer = Writer<v1::EventPacket>::create(**participant, topic::events);
    if (!writer) {
        std::fprintf(stderr, "bare_writer: %s\n", writer.error().message.c_str());
        return 1;
    }
    while ((*writer)->matched() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    SystemClock clock;
    v1::EventPacket packet;
    packet.words().resize(words);
    auto next = std::chrono::steady_clock::now();
    for (int i = 0; i < count; ++i) {
        next += period;
        std::this_thread::sleep_until(next);
        packet.sequence_number(static_cast<std::uint64_t>(i));
        packet.host_time_ns(clock.realtime_ns());
        (*writer)->write(packet);
    }
    (*writer)->wait_acknowledged({1, 0});
    return (*writer)->failures() == 0 ? 0 : 1;
}

}  // namespace
}  // namespace pursuit

int main(int argc, char** argv) {
    const int words = argc == 5 ? std::atoi(argv[2]) : 0;
    if (words < 1 || words > 8000) {
        std::fprintf(stderr, "bare_writer DOMAIN WORDS PERIOD_US COUNT\n");
        return 2;
    }
    return pursuit::run(static_cast<std::uint32_t>(std::atoi(argv[1])),
                        static_cast<std::size_t>(words),
                        std::chrono::microseconds(std::atoi(argv[3])), std::atoi(argv[4]));
}
