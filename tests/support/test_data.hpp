// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace pursuit::test {

/// The folder of recordings: PURSUIT_TEST_DATA, else ../shared/data beside the source tree.
inline std::filesystem::path data_folder() {
    const char* folder = std::getenv("PURSUIT_TEST_DATA");
    return folder != nullptr ? folder : "../shared/data";
}

/// The path of a recording, or none where it is not there.
inline std::optional<std::string> data_file(const std::string& name) {
    const auto path = data_folder() / name;
    if (!std::filesystem::exists(path)) return std::nullopt;
    return path.string();
}

}  // namespace pursuit::test

/// Declares `variable` as the path of a recording, or ends the test as skipped.
#define PURSUIT_DATA_OR_SKIP(variable, name)                                          \
    const auto variable##_found = ::pursuit::test::data_file(name);                   \
    if (!variable##_found) {                                                          \
        GTEST_SKIP() << "the recording " << (name) << " is not in "                   \
                     << ::pursuit::test::data_folder() << " (set PURSUIT_TEST_DATA)"; \
    }                                                                                 \
    const std::string& variable = *variable##_found
