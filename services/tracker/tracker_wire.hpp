// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "models.h"
#include "poses.h"
#include "requests.h"
#include "services/tracker/core/call_result.hpp"
#include "services/tracker/core/pose_record.hpp"
#include "services/tracker/core/registration.hpp"
#include "tracker_requests.h"

namespace pursuit::tracker {

// Between the core's types and those on the wire (idl/). What comes from the wire is checked here
// as far as the core's types cannot hold it (enum values, lengths of sequences); ranges and names
// are checked by the core.

CallResult<Registration> registration_of(const v1::RegisterModel& wire);
CallResult<ObjectUpdate> update_of(const v1::UpdateModel& wire);
/// `field`: what messages call it, as "start.".
CallResult<Start> start_of(const v1::StartPose& wire, const std::string& field);
CallResult<StrategyKind> strategy_of(v1::OcclusionStrategy wire);
CallResult<std::vector<NamedValue>> values_of(const std::vector<v1::NamedValue>& wire);

/// The call that asks for a registration; its inverse is registration_of().
v1::RegisterModel register_model(const Registration& registration);
v1::RegisteredModel registered_model(std::uint32_t sensor_id, const RegisteredObject& object);
v1::TrackerSettings tracker_settings(const std::string& instance, std::uint32_t sensor_id,
                                     const Settings& settings);
v1::StartPose start_pose(const Start& start);
/// All of an ObjectPose but sensor id, sequence number and host time.
void fill(v1::ObjectPose& wire, const PoseRecord& record);
v1::StatusCode status_code(CallStatus status);

}  // namespace pursuit::tracker
