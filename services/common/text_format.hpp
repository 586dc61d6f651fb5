// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <google/protobuf/message.h>

#include <string>
#include <string_view>
#include <vector>

#include "services/common/result.hpp"

namespace pursuit {

/// Reads Protobuf text into `message` and checks the ranges that its schema states (ranges.proto).
/// `name` is what errors call the text: "name:line:column: field …". On an error `message` is
/// unspecified.
Result<void> parse_text(std::string_view text, const std::string& name,
                        google::protobuf::Message& message);

/// Reads a file of Protobuf text, as parse_text(). At most 64 MiB.
Result<void> read_text_file(const std::string& path, google::protobuf::Message& message);

/// Applies "field.subfield=value" settings in order. A repeated field is appended to;
/// "field[2].subfield=value" changes the third of its messages.
Result<void> apply_settings(const std::vector<std::string>& settings,
                            google::protobuf::Message& message);

/// Writes `message` as Protobuf text, atomically: the file holds the old or the new content, also
/// after a power cut.
Result<void> write_text_file(const std::string& path, const google::protobuf::Message& message);

/// Writes `content` to `path` atomically: a temporary file beside it, fsync, rename, fsync of the
/// folder. Every write is checked.
Result<void> write_file_atomically(const std::string& path, std::string_view content);

}  // namespace pursuit
