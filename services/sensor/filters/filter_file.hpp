// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <google/protobuf/message.h>

#include <string>

#include "services/common/result.hpp"

namespace pursuit::sensor {

/// Reads the file of a filter, Protobuf text, and checks its ranges. Anybody may name a file in a
/// request: an error names file, line and column, and quotes nothing of what stands there.
Result<void> read_filter_file(const std::string& path, google::protobuf::Message& message);

}  // namespace pursuit::sensor
