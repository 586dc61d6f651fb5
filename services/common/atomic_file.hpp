// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "services/common/result.hpp"

namespace pursuit {

/// Writes `content` to `path` atomically, so that the file holds the old or the new content, also
/// after a power cut: a temporary file beside it, fsync, rename, fsync of the folder. Every write
/// is checked.
Result<void> write_file_atomically(const std::string& path, std::string_view content);

}  // namespace pursuit
