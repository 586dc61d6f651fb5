// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <mutex>

namespace pursuit {

/// Wall time, injected so that tests never sleep. Thread-safe.
class Clock {
 public:
    /// A deadline that never comes.
    static constexpr std::int64_t never_ns = std::numeric_limits<std::int64_t>::max();

    virtual ~Clock() = default;

    /// Time that only goes forward, ns since an arbitrary start.
    virtual std::int64_t steady_ns() = 0;

    /// CLOCK_REALTIME, ns since 1970; may be set by the system.
    virtual std::int64_t realtime_ns() = 0;

    /// Waits on `condition` with `lock` held until steady time `deadline_ns`, or earlier when the
    /// condition is notified (or spuriously): the caller looks at its state and waits again.
    virtual void wait_until(std::unique_lock<std::mutex>& lock, std::condition_variable& condition,
                            std::int64_t deadline_ns) = 0;
};

class SystemClock final : public Clock {
 public:
    std::int64_t steady_ns() override;
    std::int64_t realtime_ns() override;
    void wait_until(std::unique_lock<std::mutex>& lock, std::condition_variable& condition,
                    std::int64_t deadline_ns) override;
};

/// A clock for tests: time passes only in waits, and waits end at once. What another thread would
/// do meanwhile is given by at(). One thread at a time.
class ManualClock final : public Clock {
 public:
    explicit ManualClock(std::int64_t steady_ns = 0, std::int64_t realtime_ns = 0)
        : now_ns_(steady_ns), realtime_offset_ns_(realtime_ns - steady_ns) {}

    std::int64_t steady_ns() override { return now_ns_; }
    std::int64_t realtime_ns() override { return now_ns_ + realtime_offset_ns_; }
    void wait_until(std::unique_lock<std::mutex>& lock, std::condition_variable& condition,
                    std::int64_t deadline_ns) override;

    void advance(std::int64_t by_ns) { now_ns_ += by_ns; }

    /// Runs `action` inside the wait that reaches steady time `when_ns`, without the caller's lock.
    void at(std::int64_t when_ns, std::function<void()> action);

 private:
    std::int64_t now_ns_;
    std::int64_t realtime_offset_ns_;
    std::multimap<std::int64_t, std::function<void()>> actions_;
};

}  // namespace pursuit
