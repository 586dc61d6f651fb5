// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "services/common/clock.hpp"
#include "services/common/health.hpp"
#include "services/tracker/packet_intake.hpp"
#include "services/tracker/tracker_session.hpp"

namespace pursuit::tracker {

/// Whether a stream that has begun and not ended sent nothing for 100 ms of wall time: a fault of
/// the sensor or the network, not a lost track. (Its end counts as it arrives: a tracker that is
/// behind gets to it later.)
bool is_silent(const SessionFigures& figures, const IntakeCounters& intake, std::int64_t steady_ns);

/// The whole status but for its health.
v1::TrackerStatus tracker_status(const ServiceIdentity& identity, const SessionFigures& figures,
                                 const QueueFigures& queue, const IntakeCounters& intake,
                                 Clock& clock);

/// One line for systemd and the status's detail: what is done, waited for, or at fault.
std::string describe(const v1::TrackerStatus& status);
v1::ServiceState state_of(const v1::TrackerStatus& status, bool stream_open);

}  // namespace pursuit::tracker
