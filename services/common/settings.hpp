// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <google/protobuf/message.h>

#include <string>
#include <vector>

#include "services/common/field_places.hpp"
#include "services/common/result.hpp"

namespace pursuit {

/// Applies "field.subfield=value" settings in order. A repeated field is appended to;
/// "field[2].subfield=value" changes the third of its messages. What each has set is noted in
/// `places` as "--set field=value".
Result<void> apply_settings(const std::vector<std::string>& settings,
                            google::protobuf::Message& message, FieldPlaces* places = nullptr);

}  // namespace pursuit
