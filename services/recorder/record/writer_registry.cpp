// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/writer_registry.hpp"

#include <algorithm>

namespace pursuit::recorder {

namespace dds = eprosima::fastdds::dds;

Guid to_guid(const eprosima::fastrtps::rtps::GUID_t& guid) {
    Guid octets;
    std::copy_n(guid.guidPrefix.value, 12, octets.begin());
    std::copy_n(guid.entityId.value, 4, octets.begin() + 12);
    return octets;
}

std::optional<OfferedQos> WriterRegistry::find(const Guid& guid) const {
    const std::scoped_lock lock(mutex_);
    const auto found = writers_.find(guid);
    if (found == writers_.end()) return std::nullopt;
    return found->second;
}

void WriterRegistry::on_publisher_discovery(dds::DomainParticipant*,
                                            eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) {
    using Info = eprosima::fastrtps::rtps::WriterDiscoveryInfo;
    if (info.status == Info::REMOVED_WRITER) return note_gone(to_guid(info.info.guid()));
    if (info.status != Info::DISCOVERED_WRITER && info.status != Info::CHANGED_QOS_WRITER) return;
    const auto& qos = info.info.m_qos;
    OfferedQos offered;
    offered.reliability = qos.m_reliability.kind == dds::RELIABLE_RELIABILITY_QOS
                              ? mcap::Reliability::reliable
                              : mcap::Reliability::best_effort;
    offered.durability = qos.m_durability.kind == dds::VOLATILE_DURABILITY_QOS
                             ? mcap::Durability::volatile_
                             : mcap::Durability::transient_local;
    offered.ownership = qos.m_ownership.kind == dds::SHARED_OWNERSHIP_QOS
                            ? mcap::Ownership::shared
                            : mcap::Ownership::exclusive;
    const auto& deadline = qos.m_deadline.period;
    if (deadline != eprosima::fastrtps::c_TimeInfinite) offered.deadline_ns = deadline.to_ns();
    offered.partitions = qos.m_partition.getNames();
    const auto guid = to_guid(info.info.guid());
    const std::scoped_lock lock(mutex_);
    if (!writers_.insert_or_assign(guid, std::move(offered)).second) return;
    order_.push_back(guid);
    if (order_.size() > most_writers) {
        writers_.erase(order_.front());
        order_.pop_front();
    }
}

void WriterRegistry::on_participant_discovery(
    dds::DomainParticipant*, eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& info) {
    using Info = eprosima::fastrtps::rtps::ParticipantDiscoveryInfo;
    if (info.status != Info::REMOVED_PARTICIPANT && info.status != Info::DROPPED_PARTICIPANT) {
        return;
    }
    auto first = to_guid(info.info.m_guid);
    std::fill(first.begin() + 12, first.end(), std::uint8_t{0});
    const std::scoped_lock lock(mutex_);
    for (auto of_it = writers_.lower_bound(first); of_it != writers_.end(); ++of_it) {
        if (!std::equal(first.begin(), first.begin() + 12, of_it->first.begin())) break;
        of_it->second.gone = true;
    }
}

void WriterRegistry::note_gone(const Guid& guid) {
    const std::scoped_lock lock(mutex_);
    const auto found = writers_.find(guid);
    if (found != writers_.end()) found->second.gone = true;
}

}  // namespace pursuit::recorder
