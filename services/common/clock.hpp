// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <limits>
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

}  // namespace pursuit
