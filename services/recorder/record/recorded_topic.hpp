// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/recorder/mcap/facts.hpp"

namespace pursuit::recorder {

/// A topic that is recorded, as the file names it.
struct TopicFacts {
    std::string name;       ///< "pursuit/events"
    std::string type_name;  ///< "pursuit::v1::EventPacket"
    bool keyed = false;
    std::string flow;  ///< Which of the flows of services/common/qos.hpp.
    std::uint32_t history_depth = 1;
};

/// What discovery said of one writer.
struct OfferedQos {
    mcap::Reliability reliability = mcap::Reliability::reliable;
    mcap::Durability durability = mcap::Durability::volatile_;
    mcap::Ownership ownership = mcap::Ownership::shared;
    std::int64_t deadline_ns = 0;  ///< 0: none.
    std::vector<std::string> partitions;
    bool gone = false;  ///< The writer is there no more.
};

}  // namespace pursuit::recorder
