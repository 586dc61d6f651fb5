// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include <string>

#include "services/common/result.hpp"

namespace pursuit {

/// Whether every value of `message`, and of the messages in it, is finite and within the range and
/// length that its schema states (ranges.proto). The error tells of the first that is not:
/// "name:line: field dds.domain is 233, must be at most 232". `name` is what errors call the text
/// that the message was read from; `places` are its values' lines there, null where not known.
Result<void> check_ranges(const google::protobuf::Message& message, const std::string& name,
                          const google::protobuf::TextFormat::ParseInfoTree* places);

}  // namespace pursuit
