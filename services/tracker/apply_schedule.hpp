// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

namespace pursuit::tracker {

/// Calls that wait for their sensor time: in order of time, at one time in order of arrival.
/// Bounded; full, it takes no more. One thread.
template <class Call>
class ApplySchedule {
 public:
    static constexpr std::size_t capacity = 256;
    static constexpr std::int64_t never = INT64_MAX;

    [[nodiscard]] bool full() const { return calls_.size() >= capacity; }
    [[nodiscard]] std::size_t size() const { return calls_.size(); }

    /// False when full.
    [[nodiscard]] bool push(std::int64_t apply_at_us, Call call) {
        if (full()) return false;
        calls_.emplace(apply_at_us, std::move(call));  // after those of the same time
        return true;
    }

    /// The earliest time, or never.
    [[nodiscard]] std::int64_t next_us() const {
        return calls_.empty() ? never : calls_.begin()->first;
    }

    /// The earliest call, taken out. Not on an empty schedule.
    Call pop() { return std::move(calls_.extract(calls_.begin()).mapped()); }

    /// Those at or before `t_us`, in order.
    template <class Visit>
    void each_until(std::int64_t t_us, Visit visit) const {
        for (const auto& [apply_at_us, call] : calls_) {
            if (apply_at_us > t_us) return;
            visit(apply_at_us, call);
        }
    }

 private:
    std::multimap<std::int64_t, Call> calls_;
};

}  // namespace pursuit::tracker
