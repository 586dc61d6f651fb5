// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/association/plane.hpp"

namespace pursuit::tracker {

/// The events of the last while, and their sums. Each enters once and leaves once, in order of
/// time, in constant time on average. Memory is bounded: beyond the limit the oldest leaves early,
/// and the window is then shorter than asked for. Storage grows by doubling while the window fills,
/// and then no more.
///
/// Either every event counts, or, as in a matrix of last time stamps, each pixel's last alone.
class EventWindow {
 public:
    /// window_us: up to 10 s. limit: 1 … 65,536 events.
    EventWindow(std::int64_t window_us, std::size_t limit, bool is_last_per_pixel);

    /// Takes an event, not earlier than the one before.
    void add(const Event& event);

    /// Drops the events older than the window at t_us.
    void reach(std::int64_t t_us);

    void clear();

    /// Of the events that count.
    [[nodiscard]] const PlaneSums& sums() const { return sums_; }

    /// Whether it has been fed for a whole window: since the last time it was empty.
    [[nodiscard]] bool is_whole(std::int64_t t_us) const {
        return size_ > 0 && t_us - since_us_ >= window_us_;
    }

 private:
    struct Entry {
        std::int64_t t_us = 0;
        std::uint16_t x = 0;
        std::uint16_t y = 0;
        bool counts = false;  // no later event of the pixel has come
    };
    static constexpr std::uint32_t none = UINT32_MAX;

    /// Where in the ring the i-th event from the oldest on is.
    [[nodiscard]] std::size_t place_of(std::size_t i) const {
        const std::size_t place = first_ + i;
        return place < ring_.size() ? place : place - ring_.size();
    }
    void drop_oldest();
    void grow();
    // The last event of each pixel, as a hash table of places in the ring with open addressing.
    [[nodiscard]] std::size_t slot_of(std::uint16_t x, std::uint16_t y) const;
    [[nodiscard]] std::size_t home_of(std::uint16_t x, std::uint16_t y) const;
    void erase_slot(std::size_t slot);

    std::int64_t window_us_;
    std::size_t limit_;
    bool is_last_per_pixel_;
    PlaneSums sums_;
    std::int64_t since_us_ = 0;
    std::vector<Entry> ring_;
    std::size_t first_ = 0;
    std::size_t size_ = 0;
    std::vector<std::uint32_t> last_;  // a power of two, at least twice the ring
};

}  // namespace pursuit::tracker
