// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pursuit::recorder::mcap {

/// The IDL of a wire type, as schema data of encoding "omgidl": its file with every included file
/// in place of the #include, each once. Made from idl/ by the build. Empty for an unknown type.
/// type_name: as "pursuit::v1::EventPacket".
std::string_view schema_text(std::string_view type_name);

}  // namespace pursuit::recorder::mcap
