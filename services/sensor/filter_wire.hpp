// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "config.pb.h"
#include "sensor_requests.h"
#include "services/sensor/filters/filter_setting.hpp"

namespace pursuit::sensor {

/// The filters of a configuration; an error names the field.
Result<std::vector<FilterSetting>> filters_of(const disk::SensorConfig& config);

/// What a request for filters asks for, or why it cannot be granted.
struct WireFilters {
    std::vector<FilterSetting> settings;
    v1::StatusCode code = v1::STATUS_OK;
    std::string message;
};

/// Unknown filters and parameters are STATUS_NOT_FOUND; the message names field and bound.
WireFilters filters_of(const v1::SetFilters& call);

/// For a request: refuses an unknown filter, and names longer than the wire carries.
Result<v1::FilterSetting> to_wire(const FilterSetting& setting);

}  // namespace pursuit::sensor
