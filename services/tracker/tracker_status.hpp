// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

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

/// `store_failure`: why the store is not written; empty where it is.
v1::ServiceState state_of(const v1::TrackerStatus& status, const SessionFigures& figures,
                          const std::string& store_failure);
/// One line for systemd and the status's detail: what is at fault, done or waited for.
std::string describe(const v1::TrackerStatus& status, const SessionFigures& figures,
                     const std::string& store_failure);

}  // namespace pursuit::tracker
