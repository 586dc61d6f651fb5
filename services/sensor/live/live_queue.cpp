// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/live/live_queue.hpp"

#include <algorithm>
#include <utility>

namespace pursuit::sensor {

void LiveQueue::add(LiveItem item) {
    items_.push_back(std::move(item));
    changed_.notify_one();
}

void LiveQueue::begin(Geometry geometry) {
    const std::scoped_lock lock(mutex_);
    LiveItem item;
    item.kind = LiveItem::Kind::begin;
    item.geometry = geometry;
    add(std::move(item));
}

void LiveQueue::end(std::string fault) {
    const std::scoped_lock lock(mutex_);
    LiveItem item;
    item.kind = LiveItem::Kind::end;
    item.fault = std::move(fault);
    add(std::move(item));
    forget_empty_streams();
}

/// Takes an item out; what it tells of drops goes to the one behind it, whose place is returned.
LiveQueue::Items::iterator LiveQueue::take_out(Items::iterator item) {
    const auto events = item->dropped_events;
    const auto exposures = item->dropped_exposures;
    item = items_.erase(item);
    if (events + exposures == 0) return item;
    // Nothing behind it: what is about to come tells of it.
    if (item == items_.end()) item = items_.emplace(item);
    item->dropped_events += events;
    item->dropped_exposures += exposures;
    return item;
}

/// Streams of which no event is left, where many of them wait: nobody misses them.
void LiveQueue::forget_empty_streams() {
    using Kind = LiveItem::Kind;
    for (auto item = items_.begin(); items_.size() > 2 * most_streams;) {
        const auto next = item + 1;
        if (next == items_.end()) return;
        const bool only_time = item->kind == Kind::events && size_of(*item) == 0;
        if (only_time) {
            item = take_out(item);
        } else if (item->kind == Kind::begin && next->kind == Kind::end) {
            item = take_out(take_out(item));
        } else if (item->kind == Kind::end && next->kind == Kind::end) {
            item = take_out(next);  // of a stream that could not begin
        } else {
            item = next;
            continue;
        }
        // What stands before it may be empty now, too.
        if (item != items_.begin()) --item;
        if (item == items_.end()) return;
    }
}

void LiveQueue::close() {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
    changed_.notify_all();
}

void LiveQueue::push(std::span<const Event> events, std::span<const Event> exposures,
                     std::int64_t reached_us, std::int64_t host_ns) {
    const std::scoped_lock lock(mutex_);
    const auto wanted = events.size() + exposures.size();
    make_room(wanted);
    const bool joins = !items_.empty() && items_.back().kind == LiveItem::Kind::events &&
                       size_of(items_.back()) + wanted <= item_events;
    if (!joins) add({});
    auto& item = items_.back();
    item.events.insert(item.events.end(), events.begin(), events.end());
    item.exposures.insert(item.exposures.end(), exposures.begin(), exposures.end());
    item.reached_us = reached_us;
    item.host_ns = host_ns;
    totals_.waiting += wanted;
    totals_.most_waiting = std::max(totals_.most_waiting, totals_.waiting);
}

void LiveQueue::make_room(std::size_t wanted) {
    for (auto oldest = items_.begin();
         totals_.waiting + wanted > capacity_ && oldest != items_.end();) {
        if (oldest->kind != LiveItem::Kind::events) {
            ++oldest;
            continue;
        }
        totals_.waiting -= size_of(*oldest);
        totals_.dropped_events += oldest->events.size();
        totals_.dropped_exposures += oldest->exposures.size();
        oldest->dropped_events += oldest->events.size();
        oldest->dropped_exposures += oldest->exposures.size();
        // The next of the stream tells of it: more events, its end, or what is about to come.
        oldest = take_out(oldest);
    }
}

bool LiveQueue::take(LiveItem& item, std::chrono::milliseconds at_most) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, at_most, [this] { return !items_.empty() || closed_; })) {
        return false;
    }
    if (items_.empty()) return false;
    item = std::move(items_.front());
    items_.pop_front();
    totals_.waiting -= size_of(item);
    return true;
}

bool LiveQueue::finished() const {
    const std::scoped_lock lock(mutex_);
    return closed_ && items_.empty();
}

LiveQueue::Totals LiveQueue::totals() const {
    const std::scoped_lock lock(mutex_);
    return totals_;
}

}  // namespace pursuit::sensor
