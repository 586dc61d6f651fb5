// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/pixels/last_events.hpp"

namespace pursuit::tracker {

/// The events that come while an object is searched for: what is found is where it was when the
/// search began, and it is followed from there through them, some for each event that comes, until
/// it is here.
///
///     idle ── begin() ──► keeping ── go_on() … ──► caught up ── stop() ──► idle
///
/// Keeps 131,072 events at most; what comes after these is not kept, and then it is not complete.
class Chase {
 public:
    static constexpr std::size_t most = 131'072;

    /// Keeps what came since then, and all that comes.
    void begin(LastEvents& last, std::int64_t since_us);
    void stop() { is_keeping_ = false; }

    /// Every event.
    void see(const Event& event) {
        if (is_keeping_) keep(event);
    }

    /// False where more came than are kept: it cannot be followed.
    [[nodiscard]] bool is_complete() const { return is_keeping_ && is_complete_; }

    /// Calls follow(event) for the next of those kept, several for each that came meanwhile.
    template <class Follow>
    void go_on(const Follow& follow) {
        std::size_t left = at_once * (1 + kept_.size() - seen_);
        seen_ = kept_.size();
        for (; left > 0 && followed_ < kept_.size(); --left) follow(kept_[followed_++]);
    }
    [[nodiscard]] bool is_caught_up() const { return followed_ == kept_.size(); }

 private:
    static constexpr std::size_t at_once = 8;

    void keep(const Event& event);

    bool is_keeping_ = false;
    bool is_complete_ = true;
    std::vector<Event> kept_;
    std::size_t seen_ = 0;      // of those kept, by the last go_on()
    std::size_t followed_ = 0;  // of those kept
};

}  // namespace pursuit::tracker
