// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <utility>

#include "services/common/clock.hpp"

namespace pursuit::test {

/// A clock for tests: time passes only in waits, and waits end at once. What another thread would
/// do meanwhile is given by at(). One thread at a time.
class ManualClock final : public Clock {
 public:
    explicit ManualClock(std::int64_t steady_ns = 0, std::int64_t realtime_ns = 0)
        : now_ns_(steady_ns), realtime_offset_ns_(realtime_ns - steady_ns) {}

    std::int64_t steady_ns() override { return now_ns_; }
    std::int64_t realtime_ns() override { return now_ns_ + realtime_offset_ns_; }

    void wait_until(std::unique_lock<std::mutex>& lock, std::condition_variable& /*condition*/,
                    std::int64_t deadline_ns) override {
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
            std::fputs("ManualClock: a wait without an end, and no action left to end it\n",
                       stderr);
            std::abort();
        }
        now_ns_ = std::max(now_ns_, deadline_ns);
    }

    void advance(std::int64_t by_ns) { now_ns_ += by_ns; }

    /// Runs `action` inside the wait that reaches steady time `when_ns`, without the caller's lock.
    void at(std::int64_t when_ns, std::function<void()> action) {
        actions_.emplace(when_ns, std::move(action));
    }

 private:
    std::int64_t now_ns_;
    std::int64_t realtime_offset_ns_;
    std::multimap<std::int64_t, std::function<void()>> actions_;
};

}  // namespace pursuit::test
