// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pursuit::tracker {

/// The event-time grid that poses lie on: t = round(k·1e6/rate) µs. It begins with a stream's first
/// event, and is thinned in total silence so that a jump in time makes a bounded number of poses:
/// whole for 1 s after the last event, 10 Hz up to 60 s, 1 Hz up to an hour, then nothing.
class PoseGrid {
 public:
    /// rate_hz: 1 … 100,000. max_poses_per_s: of all objects together.
    PoseGrid(double rate_hz, double max_poses_per_s);

    /// The grid begins anew with the next event.
    void restart();

    /// An event was processed at t_us; never earlier than the one before.
    void event_at(std::int64_t t_us) {
        if (next_us_ == none) begin(t_us);
        last_event_us_ = t_us;
    }

    /// The next grid time; `none` (later than any time) before the first event and after an hour of
    /// silence.
    [[nodiscard]] std::int64_t next_us() const { return next_us_; }
    void step();

    /// Whether the object of this id is due at next_us(), `objects` sharing the cap evenly.
    [[nodiscard]] bool is_due(std::uint32_t object_id, std::size_t objects) const;

    static constexpr std::int64_t none = INT64_MAX;

 private:
    [[nodiscard]] std::int64_t time_of(std::int64_t k) const;
    [[nodiscard]] std::int64_t first_at_or_after(std::int64_t t_us) const;
    void begin(std::int64_t t_us);

    double period_us_;
    double rate_hz_;
    double max_poses_per_s_;
    double present_hz_;  // in a silence less
    std::int64_t next_k_ = 0;
    std::int64_t count_ = 0;  // of the grid times, from the k of the first
    std::int64_t next_us_ = none;
    std::int64_t last_event_us_ = 0;
};

}  // namespace pursuit::tracker
