// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/topic_table.hpp"

#include <array>

#include "services/common/topics.hpp"
#include "services/recorder/raw_type.hpp"

namespace pursuit::recorder {
namespace {

template <class T>
RawTopic entry(const char* name) {
    return {name, flow_of(name),
            [] { return eprosima::fastdds::dds::TypeSupport(new RawType<T>); }};
}

const char* to_string(Flow flow) {
    switch (flow) {
        case Flow::events:
            return "events";
        case Flow::poses:
            return "poses";
        case Flow::latched:
            return "latched";
        case Flow::calls:
            return "calls";
    }
    return "";
}

}  // namespace

std::span<const RawTopic> raw_topics() {
    static const std::array table = {
        entry<v1::EventPacket>(topic::events),
        entry<v1::EventPacket>(topic::exposures),
        entry<v1::ObjectPose>(topic::poses),
        entry<v1::PoseTrack>(topic::pose_tracks),
        entry<v1::RegisteredModel>(topic::models),
        entry<v1::TrackerSettings>(topic::tracker_settings),
        entry<v1::SensorStatus>(topic::sensor_status),
        entry<v1::TrackerStatus>(topic::tracker_status),
        entry<v1::RecorderStatus>(topic::recorder_status),
        entry<v1::SensorRequest>(topic::sensor_request),
        entry<v1::SensorReply>(topic::sensor_reply),
        entry<v1::TrackerRequest>(topic::tracker_request),
        entry<v1::TrackerReply>(topic::tracker_reply),
        entry<v1::RecorderRequest>(topic::recorder_request),
        entry<v1::RecorderReply>(topic::recorder_reply),
    };
    return table;
}

const RawTopic* find_raw_topic(std::string_view name) {
    for (const auto& topic : raw_topics()) {
        if (name == topic.name) return &topic;
    }
    return nullptr;
}

TopicFacts facts_of(const RawTopic& topic) {
    const auto type = topic.make_type();
    const auto qos = writer_qos(topic.flow, 20);
    return {topic.name, type.get_type_name(), type->m_isGetKeyDefined, to_string(topic.flow),
            static_cast<std::uint32_t>(qos.history().depth)};
}

}  // namespace pursuit::recorder
