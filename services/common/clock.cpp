// SPDX-License-Identifier: Apache-2.0
#include "services/common/clock.hpp"

#include <chrono>

namespace pursuit {

using std::chrono::duration_cast;
using std::chrono::nanoseconds;
using std::chrono::steady_clock;
using std::chrono::system_clock;

std::int64_t SystemClock::steady_ns() {
    return duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()).count();
}

std::int64_t SystemClock::realtime_ns() {
    return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

void SystemClock::wait_until(std::unique_lock<std::mutex>& lock, std::condition_variable& condition,
                             std::int64_t deadline_ns) {
    if (deadline_ns == never_ns) {
        condition.wait(lock);
    } else {
        condition.wait_until(lock, steady_clock::time_point(nanoseconds(deadline_ns)));
    }
}

}  // namespace pursuit
