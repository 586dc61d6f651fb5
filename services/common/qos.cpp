// SPDX-License-Identifier: Apache-2.0
#include "services/common/qos.hpp"

#include <algorithm>
#include <string_view>

#include "services/common/topics.hpp"

namespace pursuit {

namespace dds = eprosima::fastdds::dds;

namespace {

struct FlowQos {
    int depth;
    bool latched;
    eprosima::fastrtps::rtps::MemoryManagementPolicy_t memory;
};

FlowQos qos_of(Flow flow) {
    using namespace eprosima::fastrtps::rtps;
    switch (flow) {
        case Flow::events:
            return {64, false, PREALLOCATED_WITH_REALLOC_MEMORY_MODE};
        case Flow::poses:
            return {16, false, PREALLOCATED_WITH_REALLOC_MEMORY_MODE};
        case Flow::latched:
            return {1, true, PREALLOCATED_WITH_REALLOC_MEMORY_MODE};
        case Flow::calls:
            break;
    }
    // Replies differ much in size: a model of 4096 points beside a single word.
    return {128, false, DYNAMIC_RESERVE_MEMORY_MODE};
}

template <class Qos>
void apply(Qos& qos, const FlowQos& flow) {
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = flow.depth;
    qos.durability().kind =
        flow.latched ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
    qos.endpoint().history_memory_policy = flow.memory;
    // Fast DDS would share the memory of a history with readers on the same host. A writer killed
    // while it holds the lock in there takes its readers with it, by an exception that nobody can
    // catch, and leaves its file in /dev/shm.
    qos.data_sharing().off();
    // Keyed topics: at most this many objects or services at once.
    qos.resource_limits().max_instances = 1024;
    qos.resource_limits().max_samples_per_instance = flow.depth;
    qos.resource_limits().max_samples = 1024 * flow.depth;
    qos.resource_limits().allocated_samples = flow.depth;
}

}  // namespace

Flow flow_of(const char* topic_name) {
    const std::string_view name = topic_name;
    if (name == topic::events || name == topic::exposures || name == topic::pose_tracks) {
        return Flow::events;
    }
    if (name == topic::poses) return Flow::poses;
    if (name.ends_with("/request") || name.ends_with("/reply")) return Flow::calls;
    return Flow::latched;
}

dds::DataWriterQos writer_qos(Flow flow, std::uint32_t heartbeat_ms) {
    dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
    apply(qos, qos_of(flow));
    qos.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
    const auto period_ns = heartbeat_ms * 1'000'000ULL;
    auto& times = qos.reliable_writer_qos().times;
    times.heartbeatPeriod = {static_cast<std::int32_t>(period_ns / 1'000'000'000ULL),
                             static_cast<std::uint32_t>(period_ns % 1'000'000'000ULL)};
    // With 0, the default, every write wakes a thread that then contends for the writer's lock
    // (13,600 futex calls a second at 2000 poses/s, 3,400 with 5 ms). Who has just been sent a
    // sample cannot miss it for so long: a part of what it waits for the next heartbeat. Then its
    // request is answered at once, and not after 5 ms, the default.
    times.nackSupressionDuration = {
        0, static_cast<std::uint32_t>(std::min<std::uint64_t>(period_ns / 4, 5'000'000))};
    times.nackResponseDelay = {0, 0};
    return qos;
}

dds::DataReaderQos reader_qos(Flow flow) {
    dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
    apply(qos, qos_of(flow));
    return qos;
}

std::string policy_name(dds::QosPolicyId_t policy) {
    switch (policy) {
        case dds::DURABILITY_QOS_POLICY_ID:
            return "DURABILITY";
        case dds::DEADLINE_QOS_POLICY_ID:
            return "DEADLINE";
        case dds::LATENCYBUDGET_QOS_POLICY_ID:
            return "LATENCY_BUDGET";
        case dds::OWNERSHIP_QOS_POLICY_ID:
            return "OWNERSHIP";
        case dds::LIVELINESS_QOS_POLICY_ID:
            return "LIVELINESS";
        case dds::RELIABILITY_QOS_POLICY_ID:
            return "RELIABILITY";
        case dds::DESTINATIONORDER_QOS_POLICY_ID:
            return "DESTINATION_ORDER";
        case dds::PRESENTATION_QOS_POLICY_ID:
            return "PRESENTATION";
        case dds::DATAREPRESENTATION_QOS_POLICY_ID:
            return "DATA_REPRESENTATION";
        default:
            return "policy " + std::to_string(policy);
    }
}

}  // namespace pursuit
