// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/temporal.hpp"

#include <algorithm>
#include <cmath>

#include "services/tracker/core/association/by_distance.hpp"

namespace pursuit::tracker {

const Temporal::History* Temporal::find(std::uint32_t object_id) const {
    for (const History& history : histories_) {
        if (history.object_id == object_id) return &history;
    }
    return nullptr;
}

void Temporal::assign(const Event& event, std::span<Claim> claims) {
    Claim* best = nullptr;
    double best_off = 0;
    for (Claim& claim : claims) {
        claim.weight = 0;
        const History* history = find(claim.object_id);
        if (history == nullptr || history->times_us.size() < events_) {
            Closest().assign(event, claims);
            return;
        }
        const std::size_t oldest = history->next;
        const std::size_t newest = (history->next + events_ - 1) % events_;
        const std::int64_t last_us = history->times_us[newest];
        // (3.12); events of one microsecond are taken as spread over it.
        const double span_us =
            std::max(1.0, static_cast<double>(last_us - history->times_us[oldest]));
        const double rate_per_us = static_cast<double>(events_ - 1) / span_us;
        // (3.13)
        const double off = std::abs(static_cast<double>(event.t_us - last_us) * rate_per_us - 1);
        if (best == nullptr || off < best_off) {
            best = &claim;
            best_off = off;
        }
    }
    best->weight = 1;
}

void Temporal::forget(std::uint32_t object_id) {
    std::erase_if(histories_,
                  [&](const History& history) { return history.object_id == object_id; });
}

void Temporal::used(const Event& event, const Claim& claim) {
    auto* history = const_cast<History*>(find(claim.object_id));
    if (history == nullptr) {
        histories_.push_back({claim.object_id, {}, 0});
        history = &histories_.back();
        history->times_us.reserve(events_);
    }
    if (history->times_us.size() < events_) {
        history->times_us.push_back(event.t_us);
        return;
    }
    history->times_us[history->next] = event.t_us;
    history->next = (history->next + 1) % events_;
}

}  // namespace pursuit::tracker
