// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "services/ctl/grey/grey_image.hpp"
#include "services/sensor/formats/formats.hpp"

namespace pursuit::ctl {

/// The image of a recording of events at sensor time `at_us`: of every measurement that ended by
/// then. An error where the format has no measurements, or the recording ends more than 20 ms
/// earlier.
Result<GreyImage> grey_of_events(const std::string& path, const sensor::ReadOptions& options,
                                 std::int64_t at_us);

/// The same of the topic pursuit/exposures in an MCAP recording; of its first stream of sensor
/// `sensor_id` (0: of whichever comes first).
Result<GreyImage> grey_of_mcap(const std::string& path, std::uint32_t sensor_id,
                               std::int64_t at_us);

}  // namespace pursuit::ctl
