// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "services/common/result.hpp"

namespace pursuit {

/// The whole content of a regular file of at most `most_mib` MiB. Anything else is refused: a FIFO
/// would be waited for, and a device need not end. Returns soon whatever `path` names.
Result<std::string> read_small_file(const std::string& path, std::size_t most_mib);

}  // namespace pursuit
