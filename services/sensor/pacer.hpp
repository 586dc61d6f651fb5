// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

#include "services/common/clock.hpp"

namespace pursuit::sensor {

/// Plays sensor time on the wall clock: at `rate` times real time, 0 = as fast as possible.
///
///     playing ──pause()──► paused ──resume()──► playing
///        └──────── stop() ────┴──► stopped (for good)
///
/// Sensor time is tied to the wall clock at the first wait, and again wherever the rate changes or
/// play resumes, from the sensor time reached: nothing is skipped or repeated. A sender that falls
/// behind is let through without waiting until it has caught up; lag_us() tells by how much.
///
/// Threads: one waits; every other method may be called from any thread, and acts at once on a
/// wait in progress.
class Pacer {
 public:
    /// `clock` must outlive the pacer. `rate` 0 or 0.001 … 1000.
    Pacer(Clock& clock, double rate);

    /// Returns when sensor time `t_us` is due: true; or after stop(): false.
    bool wait_until(std::int64_t t_us);

    void set_rate(double rate);
    void pause();
    void resume();
    void stop();

    /// Forgets where sensor time was: another stream begins with the next wait.
    void restart();

    double rate() const;
    bool paused() const;
    bool stopped() const;

    /// How much later than due the last wait returned, us of wall time; 0 as fast as possible.
    std::int64_t lag_us() const;

    /// CLOCK_REALTIME of sensor time `t_us`; as fast as possible: the present.
    std::int64_t host_time_ns(std::int64_t t_us) const;

 private:
    struct Tie {
        std::int64_t t_us;
        std::int64_t steady_ns;
    };

    std::int64_t due_ns(std::int64_t t_us) const;
    void hold();  // ends the tie at the present, remembering the sensor time reached

    Clock& clock_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    double rate_;
    bool paused_ = false;
    bool stopped_ = false;
    std::optional<Tie> tie_;                  // none: as fast as possible, paused, or not begun
    std::optional<std::int64_t> reached_us_;  // where the next tie goes on
    std::int64_t lag_us_ = 0;
};

}  // namespace pursuit::sensor
