// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/live/stop_signal.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

namespace pursuit::sensor {

StopSignal::StopSignal() : event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (event_ < 0) throw std::runtime_error(std::string("eventfd: ") + std::strerror(errno));
}

StopSignal::~StopSignal() { ::close(event_); }

void StopSignal::raise() {
    raised_ = true;
    const std::uint64_t one = 1;
    // It can only fail when it is raised already.
    [[maybe_unused]] const auto written = ::write(event_, &one, sizeof one);
}

bool StopSignal::wait(int file, short events, std::chrono::milliseconds at_most) const {
    using std::chrono::steady_clock;
    const auto end = steady_clock::now() + at_most;
    for (;;) {
        pollfd polled[] = {{event_, POLLIN, 0}, {file, events, 0}};
        int wait_ms = -1;
        if (at_most.count() >= 0) {
            const auto left =
                std::chrono::ceil<std::chrono::milliseconds>(end - steady_clock::now());
            wait_ms = static_cast<int>(std::max<std::int64_t>(left.count(), 0));
        }
        const int ready = ::poll(polled, 2, wait_ms);
        if (raised_ || polled[0].revents != 0) return false;
        if (ready > 0) return true;
        if (ready == 0) return false;
        if (errno != EINTR) return true;  // what is wrong, the descriptor's next use tells
    }
}

}  // namespace pursuit::sensor
