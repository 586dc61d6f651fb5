// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/replay_topics.hpp"

#include <algorithm>

#include "services/common/topics.hpp"

namespace pursuit::recorder {

bool carries_packets(const std::string& topic) {
    return topic == topic::events || topic == topic::exposures;
}

std::string replay_refusal(const std::string& topic) {
    if (topic == topic::tracker_request || carries_packets(topic)) return "";
    if (topic.ends_with("/request") || topic.ends_with("/reply")) {
        return "a replay does not send " + topic;
    }
    return "";
}

bool is_replayed(const std::string& topic, const std::vector<std::string>& wanted) {
    if (wanted.empty()) return carries_packets(topic) || topic == topic::tracker_request;
    return std::find(wanted.begin(), wanted.end(), topic) != wanted.end();
}

}  // namespace pursuit::recorder
