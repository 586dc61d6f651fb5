// SPDX-License-Identifier: Apache-2.0
#include "services/common/clock.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <utility>

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

void ManualClock::wait_until(std::unique_lock<std::mutex>& lock,
                             std::condition_variable& /*condition*/, std::int64_t deadline_ns) {
    if (!actions_.empty() && actions_.begin()->first <= deadline_ns) {
        auto node = actions_.extract(actions_.begin());
        now_ns_ = std::max(now_ns_, node.key());
        lock.unlock();
        node.mapped()();
        lock.lock();
        return;
    }
    if (deadline_ns == never_ns) {
        // A test that waits for ever would hang; nothing it could check comes after this.
        std::fputs("ManualClock: a wait without an end, and no action left to end it\n", stderr);
        std::abort();
    }
    now_ns_ = std::max(now_ns_, deadline_ns);
}

void ManualClock::at(std::int64_t when_ns, std::function<void()> action) {
    actions_.emplace(when_ns, std::move(action));
}

}  // namespace pursuit
