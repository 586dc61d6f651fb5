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

/// Streams of which no event is left, where many of them wait: nobody misses them.
void LiveQueue::forget_empty_streams() {
    const auto is = [](const LiveItem& item, LiveItem::Kind kind) { return item.kind == kind; };
    for (auto item = items_.begin(); items_.size() > 2 * most_streams;) {
        item = std::adjacent_find(item, items_.end(), [&](const auto& a, const auto& b) {
            return is(a, LiveItem::Kind::begin) && is(b, LiveItem::Kind::end);
        });
        if (item == items_.end()) return;
        item = items_.erase(item, item + 2);
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
        const auto events = oldest->dropped_events + oldest->events.size();
        const auto exposures = oldest->dropped_exposures + oldest->exposures.size();
        oldest = items_.erase(oldest);
        // The next of the stream tells of it: more events, its end, or what is about to come.
        if (oldest == items_.end()) oldest = items_.emplace(oldest);
        oldest->dropped_events += events;
        oldest->dropped_exposures += exposures;
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
