// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "services/common/result.hpp"

namespace pursuit {

/// The file that `path` leads to when every symbolic link at its end is followed, whether that file
/// is there or not. An error where the links go round in a circle.
Result<std::string> followed_links(const std::string& path);

/// Writes `content` to `path` atomically, so that the file holds the old or the new content, also
/// after a power cut: a temporary file beside it, fsync, rename, fsync of the folder. Every write
/// is checked. Where `path` is a symbolic link the file that it leads to is replaced, the link
/// stays. What is there and no regular file is refused.
Result<void> write_file_atomically(const std::string& path, std::string_view content);

/// What a command was told to write: atomically, or straight into what could not be replaced, as a
/// FIFO or character device (/dev/stdout).
Result<void> write_output(const std::string& path, std::string_view content);

}  // namespace pursuit
