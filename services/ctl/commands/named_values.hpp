// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "models.h"
#include "services/common/result.hpp"

namespace pursuit::ctl {

/// "name=value" settings as a request carries them; an error names the setting. Names are cut by
/// the generated types, so their length is checked here.
Result<std::vector<v1::NamedValue>> named_values(const std::vector<std::string>& settings);

/// "name = value" lines, each behind two spaces.
std::string listed(const std::vector<v1::NamedValue>& values);

}  // namespace pursuit::ctl
