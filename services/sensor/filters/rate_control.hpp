// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "services/sensor/filters/filter.hpp"
#include "services/sensor/filters/filter_setting.hpp"

namespace pursuit::sensor {

inline constexpr std::array rate_control_parameters{
    FilterParameter{"max_rate_hz", 1, 1e9, 10e6, false, "1/s", "events a second that pass"},
    FilterParameter{"window_us", 10, 1e6, 1000, true, "us", "the rate is kept in each of these"},
};

/// Keeps the rate of events, in windows of event time that begin with the first event, at most
/// max_rate_hz · window_us events a window. Where the window before had more, events are thinned
/// evenly by that excess; whatever is beyond the limit all the same, as at the begin of a burst, is
/// dropped to the window's end. Refuses a limit of less than one event a window.
///
/// What it drops was real and is lost: packets say so in dropped_events.
Result<std::unique_ptr<Filter>> make_rate_control(const FilterArguments& arguments, Geometry input);

}  // namespace pursuit::sensor
