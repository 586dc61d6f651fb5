// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iostream>

#include "services/common/result.hpp"
#include "services/common/service_main.hpp"

namespace pursuit::ctl {

/// Prints an error as every sub-command does and gives its exit code.
inline int report(const Error& error, ExitCode code = exit_failure) {
    std::cerr << "pursuitctl: " << error.message << '\n';
    return code;
}

}  // namespace pursuit::ctl
