// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "events.h"

namespace pursuit::sensor {

/// A topic of packets, as the one who sends sees it.
struct PacketOutput {
    /// False when the packet was not taken.
    std::function<bool(v1::EventPacket&)> write;
    /// Waits until every reader has acknowledged what was written; false when the time has passed.
    std::function<bool(std::chrono::milliseconds)> wait_acknowledged;
    /// How many readers there are.
    std::function<int()> readers;
};

/// Where a sensor's streams go. Knows no middleware.
struct StreamOutputs {
    PacketOutput events;
    PacketOutput exposures;
    std::function<void(const std::string&)> error;  ///< For log and status.
};

}  // namespace pursuit::sensor
