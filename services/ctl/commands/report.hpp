// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>

#include "services/common/result.hpp"
#include "services/common/service_main.hpp"

namespace pursuit::ctl {

/// Prints an error as every sub-command does and gives its exit code.
inline int report(const Error& error, ExitCode code = exit_failure) {
    std::cerr << "pursuitctl: " << error.message << '\n';
    return code;
}

/// Where to tell what was written to `output`: not into the midst of it.
inline std::FILE* summary_of(const std::string& output) {
    std::error_code not_there;  // Then it is not standard output either.
    return std::filesystem::equivalent(output, "/dev/stdout", not_there) ? stderr : stdout;
}

}  // namespace pursuit::ctl
