// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "services/common/clock.hpp"
#include "services/common/health.hpp"
#include "services/tracker/tracker_session.hpp"
#include "services/tracker/work_queue.hpp"

namespace pursuit::tracker {

/// What the listener counts. Threads: any.
struct IntakeCounters {
    std::atomic<std::uint64_t> dropped_packets{0};       ///< Pushed out of the full queue …
    std::atomic<std::uint64_t> dropped_events{0};        ///< … and the events in them.
    std::atomic<std::uint64_t> refused_requests{0};      ///< Because too many waited.
    std::atomic<std::int64_t> last_packet_steady_ns{0};  ///< 0: none yet.
};

/// Whether a stream that has begun and not ended sent nothing for 100 ms of wall time: a fault of
/// the sensor or the network, not a lost track.
bool is_silent(const SessionFigures& figures, const IntakeCounters& intake, std::int64_t steady_ns);

/// The whole status but for its health.
v1::TrackerStatus tracker_status(const ServiceIdentity& identity, const SessionFigures& figures,
                                 const QueueFigures& queue, const IntakeCounters& intake,
                                 Clock& clock);

/// One line for systemd and the status's detail: what is done, waited for, or at fault.
std::string describe(const v1::TrackerStatus& status);
v1::ServiceState state_of(const v1::TrackerStatus& status, bool stream_open);

}  // namespace pursuit::tracker
