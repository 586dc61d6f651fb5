// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace pursuit::recorder {

// Which topics of a recording are replayed, and how.

/// Whether the topic's messages are EventPackets.
bool carries_packets(const std::string& topic);

/// Why a topic cannot be replayed; empty when it can.
std::string replay_refusal(const std::string& topic);

/// Whether a topic is replayed where `wanted` are asked for. Where none are: what carries packets,
/// and the calls on the tracker.
bool is_replayed(const std::string& topic, const std::vector<std::string>& wanted);

}  // namespace pursuit::recorder
