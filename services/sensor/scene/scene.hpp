// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene.pb.h"
#include "services/common/result.hpp"

namespace pursuit::sensor {

/// A scene description that has been checked as a whole: a simulation of it cannot fail.
class Scene {
 public:
    const disk::Scene& description() const { return description_; }

 private:
    friend Result<Scene> parse_scene(std::string_view, const std::string&,
                                     const std::vector<std::string>&);

    disk::Scene description_;
};

/// Reads Protobuf text (idl/scene.proto), then applies settings, as apply_settings(). Errors begin
/// with `name`, or with the setting.
Result<Scene> parse_scene(std::string_view text, const std::string& name,
                          const std::vector<std::string>& settings = {});

/// A built-in scene by its name, or a file.
Result<Scene> load_scene(const std::string& path_or_builtin_name,
                         const std::vector<std::string>& settings = {});

/// Names of the scenes that are part of the program, sorted.
std::vector<std::string> list_builtin_scenes();

}  // namespace pursuit::sensor
