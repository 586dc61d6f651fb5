// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "services/common/event.hpp"

namespace pursuit {

/// Pixels as a person states them, "640x480": at most 65535 to the right and 32768 downwards, as a
/// word of an EventPacket holds. Nothing where the text is anything else.
std::optional<Geometry> parse_geometry(std::string_view text);

}  // namespace pursuit
