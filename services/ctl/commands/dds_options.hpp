// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "services/common/result.hpp"

namespace pursuit {
class Participant;
}

namespace pursuit::ctl {

/// What every sub-command that talks to services is told.
struct DdsOptions {
    std::uint32_t domain = 0;
    std::string name;  ///< Of the sensor; empty: whichever there is.
    bool loopback = false;
    std::uint32_t timeout_ms = 5000;

    [[nodiscard]] std::chrono::milliseconds timeout() const {
        return std::chrono::milliseconds(timeout_ms);
    }
};

void add_dds_options(CLI::App& app, DdsOptions& options);

/// Joins the domain; with a name, hears and is heard by the services of that sensor alone.
Result<std::unique_ptr<Participant>> join(const DdsOptions& options);

/// "in domain 7" or "of sensor front in domain 7": where nobody answered.
std::string where(const DdsOptions& options);

}  // namespace pursuit::ctl
