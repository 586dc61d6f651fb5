// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/event_window.hpp"

#include <algorithm>
#include <bit>

namespace pursuit::tracker {
namespace {

constexpr std::size_t first_storage = 1024;

}  // namespace

EventWindow::EventWindow(std::int64_t window_us, std::size_t limit, bool is_last_per_pixel)
    : window_us_(window_us), limit_(limit), is_last_per_pixel_(is_last_per_pixel) {
    grow();
}

void EventWindow::add(const Event& event) {
    reach(event.t_us);
    if (size_ == limit_) drop_oldest();
    if (size_ == ring_.size()) grow();
    if (size_ == 0) since_us_ = event.t_us;
    const std::size_t place = place_of(size_);
    ring_[place] = {event.t_us, event.x, event.y, true};
    ++size_;
    sums_.add(event.x, event.y, event.t_us);
    if (!is_last_per_pixel_) return;
    const std::size_t slot = slot_of(event.x, event.y);
    if (last_[slot] != none) {
        Entry& former = ring_[last_[slot]];
        former.counts = false;
        sums_.remove(former.x, former.y, former.t_us);
    }
    last_[slot] = static_cast<std::uint32_t>(place);
}

void EventWindow::reach(std::int64_t t_us) {
    if (size_ == 0) return;
    if (ring_[place_of(size_ - 1)].t_us < t_us - window_us_) {
        clear();
        return;
    }
    while (ring_[first_].t_us < t_us - window_us_) drop_oldest();
}

void EventWindow::clear() {
    sums_.clear();
    first_ = size_ = 0;
    std::fill(last_.begin(), last_.end(), none);
}

void EventWindow::drop_oldest() {
    const Entry& oldest = ring_[first_];
    if (oldest.counts) {
        sums_.remove(oldest.x, oldest.y, oldest.t_us);
        if (is_last_per_pixel_) erase_slot(slot_of(oldest.x, oldest.y));
    }
    first_ = place_of(1);
    --size_;
}

void EventWindow::grow() {
    std::vector<Entry> larger(std::min(limit_, ring_.empty() ? first_storage : 2 * ring_.size()));
    for (std::size_t i = 0; i < size_; ++i) larger[i] = ring_[place_of(i)];
    ring_ = std::move(larger);
    first_ = 0;
    if (!is_last_per_pixel_) return;
    last_.assign(std::bit_ceil(2 * ring_.size()), none);
    for (std::size_t i = 0; i < size_; ++i) {
        if (!ring_[i].counts) continue;
        last_[slot_of(ring_[i].x, ring_[i].y)] = static_cast<std::uint32_t>(i);
    }
}

std::size_t EventWindow::home_of(std::uint16_t x, std::uint16_t y) const {
    const std::uint32_t pixel = (std::uint32_t{y} << 16) | x;
    // Fibonacci hashing: the high bits of the product are mixed best.
    return ((pixel * std::uint64_t{0x9E3779B97F4A7C15}) >> 32) & (last_.size() - 1);
}

std::size_t EventWindow::slot_of(std::uint16_t x, std::uint16_t y) const {
    std::size_t slot = home_of(x, y);
    for (; last_[slot] != none; slot = (slot + 1) & (last_.size() - 1)) {
        const Entry& there = ring_[last_[slot]];
        if (there.x == x && there.y == y) break;
    }
    return slot;
}

void EventWindow::erase_slot(std::size_t slot) {
    const std::size_t mask = last_.size() - 1;
    // What was pushed on past this slot moves back, so that no search ends before it.
    for (std::size_t next = (slot + 1) & mask; last_[next] != none; next = (next + 1) & mask) {
        const Entry& entry = ring_[last_[next]];
        if (((next - home_of(entry.x, entry.y)) & mask) < ((next - slot) & mask)) continue;
        last_[slot] = last_[next];
        slot = next;
    }
    last_[slot] = none;
}

}  // namespace pursuit::tracker
