// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/dds/topic/TypeSupport.hpp>
#include <span>
#include <string_view>

#include "services/common/qos.hpp"
#include "services/recorder/record/recorded_topic.hpp"

namespace pursuit::recorder {

/// A topic of Pursuit as the recorder reads and writes it.
struct RawTopic {
    const char* name;
    Flow flow;
    eprosima::fastdds::dds::TypeSupport (*make_type)();  ///< A RawType.
};

/// Every topic of services/common/topics.hpp, in that order.
std::span<const RawTopic> raw_topics();

/// Null where there is none of that name.
const RawTopic* find_raw_topic(std::string_view name);

/// As a file names it.
TopicFacts facts_of(const RawTopic& topic);

}  // namespace pursuit::recorder
