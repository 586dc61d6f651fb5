// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <google/protobuf/message.h>

#include <string>
#include <string_view>

#include "services/common/field_places.hpp"
#include "services/common/result.hpp"

namespace pursuit {

/// What an error says of the text besides where it is: its line, or, where anybody may name the
/// file in a request, nothing of what stands there.
enum class Quoting { line, nothing };

/// Reads Protobuf text into `message` and checks that it gives no field twice that is not repeated,
/// that none is missing that must be there, and the ranges that its schema states (ranges.hpp).
/// `name` is what errors call the text: "name:line:column: field …". Where each field was read goes
/// to `places`. On an error `message` is unspecified.
Result<void> parse_text(std::string_view text, const std::string& name,
                        google::protobuf::Message& message, FieldPlaces* places = nullptr,
                        Quoting quoting = Quoting::line);

/// As parse_text(), over what `message` holds already: fields of the text replace it, or are added
/// to it where they are repeated.
Result<void> merge_text(std::string_view text, const std::string& name,
                        google::protobuf::Message& message);

/// Reads a regular file of Protobuf text, as parse_text(). At most 64 MiB.
Result<void> read_text_file(const std::string& path, google::protobuf::Message& message,
                            FieldPlaces* places = nullptr, Quoting quoting = Quoting::line);

/// Writes `message` as Protobuf text, as write_output().
Result<void> write_text_file(const std::string& path, const google::protobuf::Message& message);

}  // namespace pursuit
