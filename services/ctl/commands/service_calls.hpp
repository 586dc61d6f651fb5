// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "recorder_requests.h"
#include "sensor_requests.h"
#include "services/common/result.hpp"
#include "services/ctl/commands/dds_options.hpp"
#include "tracker_requests.h"

namespace pursuit::ctl {

// Each sends one request and gives the reply to it; an error when nobody answers, or when the
// service refuses, with the service's own words.

Result<v1::TrackerReply> call_tracker(const DdsOptions& options, v1::TrackerRequest& request);
Result<v1::SensorReply> call_sensor(const DdsOptions& options, v1::SensorRequest& request);
Result<v1::RecorderReply> call_recorder(const DdsOptions& options, v1::RecorderRequest& request);

}  // namespace pursuit::ctl
