// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "services/tracker/core/registration.hpp"
#include "services/tracker/model_store.hpp"

namespace pursuit::tracker {

// What a former run left holds over the configuration, because requests may have changed it since.
// A configuration that was changed meanwhile has no effect then, and somebody must be told.

/// What of the configured model an object of its name that came from the store has otherwise, for
/// people: "shape, gate_px 4 instead of 8". Empty: nothing. `new_objects`: what is configured for
/// all objects.
std::string differences(const Registration& configured, const RegisteredObject& stored,
                        const ObjectParameters& new_objects);

/// Likewise of the settings; `configured` are those in force before the store's are set.
std::string differences(const Settings& configured, const RequestedSettings& stored);

}  // namespace pursuit::tracker
