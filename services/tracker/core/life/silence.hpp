// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pursuit::tracker {

/// Whether an object's own events have stopped all at once: none where many should have come. What
/// was said of its pose until then may not hold after it.
///
///     heard ── begins() ──► silent ── hear() ──► heard
///
/// Thread: the tracker's.
class Silence {
 public:
    /// Nothing was heard yet.
    void restart() { *this = Silence(); }

    /// An event that is thought to be the object's own. True after a pause: none came in the
    /// last half ms.
    bool hear(std::int64_t t_us) {
        const bool was_pause = t_us - heard_us_ > pause_us;
        heard_us_ = t_us;
        is_silent_ = false;
        return was_pause;
    }
    /// The last of them; -1 before the first.
    [[nodiscard]] std::int64_t heard_us() const { return heard_us_; }

    /// Since the last of them, s.
    [[nodiscard]] double lasts_s(std::int64_t t_us) const {
        return static_cast<double>(t_us - heard_us_) * 1e-6;
    }
    /// Fewer came than it makes at its usual rate.
    [[nodiscard]] bool is_silent(std::int64_t t_us, double usual_rate_hz) const {
        return heard_us_ >= 0 && lasts_s(t_us) * usual_rate_hz > silent_events;
    }
    /// True once for each silence, when it has lasted long enough, or the object may have gone on
    /// in it.
    bool begins(std::int64_t t_us, double usual_rate_hz, double speed_px_s) {
        if (is_silent_ || !is_silent(t_us, usual_rate_hz)) return false;
        if (t_us - heard_us_ < silent_us && lasts_s(t_us) * speed_px_s < silent_way_px)
            return false;
        is_silent_ = true;
        return true;
    }

 private:
    static constexpr double silent_events = 30;  // that should have come
    static constexpr std::int64_t silent_us = 3'000;
    static constexpr double silent_way_px = 2.5;
    static constexpr std::int64_t pause_us = 500;

    std::int64_t heard_us_ = -1;
    bool is_silent_ = false;
};

}  // namespace pursuit::tracker
