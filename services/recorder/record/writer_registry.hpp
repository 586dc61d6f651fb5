// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <map>
#include <mutex>
#include <optional>

#include "services/recorder/record/recorded_topic.hpp"
#include "services/recorder/record/sample.hpp"

namespace pursuit::recorder {

/// The octets of a Fast DDS GUID.
Guid to_guid(const eprosima::fastrtps::rtps::GUID_t& guid);

/// Remembers how every writer that discovery finds offers its topic, also after it has gone, as its
/// samples may still wait for the disk. At most 8192; the oldest are forgotten. Threads: any.
class WriterRegistry : public eprosima::fastdds::dds::DomainParticipantListener {
 public:
    /// What the writer offered; nothing where it is not known.
    std::optional<OfferedQos> find(const Guid& guid) const;

 private:
    void on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant*,
                                eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;

    void on_participant_discovery(
        eprosima::fastdds::dds::DomainParticipant*,
        eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& info) override;
    void note_gone(const Guid& guid);

    static constexpr std::size_t most_writers = 8192;
    mutable std::mutex mutex_;
    std::map<Guid, OfferedQos> writers_;
    std::deque<Guid> order_;
};

}  // namespace pursuit::recorder
