// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "status.h"

namespace pursuit::ctl {

// The statuses of the services for people and for programs.

/// Every field as one JSON object, named as in idl/status.idl, the health's fields among the
/// others; dropped_by as an object by cause.
std::string status_json(const v1::SensorStatus& status);
std::string status_json(const v1::TrackerStatus& status);
std::string status_json(const v1::RecorderStatus& status);

/// A headline and a few indented lines.
std::string status_lines(const v1::SensorStatus& status);
std::string status_lines(const v1::TrackerStatus& status);
std::string status_lines(const v1::RecorderStatus& status);

/// WAITING, RUNNING, …
std::string state_name(v1::ServiceState state);

}  // namespace pursuit::ctl
