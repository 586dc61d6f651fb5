// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

namespace pursuit::sensor {

struct BuiltinScene {
    std::string_view name;
    std::string_view text;
};

/// The files of builtin/, made part of the library by the build; sorted by name.
const std::vector<BuiltinScene>& builtin_scenes();

}  // namespace pursuit::sensor
