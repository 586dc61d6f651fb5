// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "config.pb.h"
#include "services/common/result.hpp"

namespace pursuit {

/// What the transport did to samples, over all readers of a participant; running totals.
struct TransportCounts {
    std::atomic<std::uint64_t> lost{0};      ///< never received, as the middleware reports it
    std::atomic<std::uint64_t> rejected{0};  ///< received, and no room for them
    std::shared_ptr<std::atomic<std::uint64_t>> malformed =
        std::make_shared<std::atomic<std::uint64_t>>(0);  ///< refused by the deserialiser
    std::atomic<std::uint64_t> incompatible{0};           ///< peers whose QoS does not match ours
};

/// One participant with one publisher and one subscriber: the single place where transport,
/// discovery and partitions are set up. Readers and writers must go before it.
/// Threads: any, as Fast DDS allows.
class Participant {
 public:
    /// `name` is seen by discovery tools; `sensor` is the partition offered besides the default
    /// one ("" = the default one only).
    static Result<std::unique_ptr<Participant>> create(const disk::Dds& settings,
                                                       const std::string& name,
                                                       const std::string& sensor);
    /// Whether the settings are good; told with the field. Joins nothing.
    static Result<void> check(const disk::Dds& settings);
    ~Participant();
    Participant(const Participant&) = delete;
    Participant& operator=(const Participant&) = delete;

    /// The topic of that name, made at the first call. The type of a topic cannot change.
    Result<eprosima::fastdds::dds::Topic*> topic(const std::string& name,
                                                 eprosima::fastdds::dds::TypeSupport type);

    eprosima::fastdds::dds::DomainParticipant& dds() { return *participant_; }
    eprosima::fastdds::dds::Publisher& publisher() { return *publisher_; }
    eprosima::fastdds::dds::Subscriber& subscriber() { return *subscriber_; }
    TransportCounts& counts() { return counts_; }
    /// A peer was not matched because of `policy`: counted, and told once for each topic and
    /// policy.
    void incompatible(const std::string& topic, eprosima::fastdds::dds::QosPolicyId_t policy);
    std::uint32_t heartbeat_ms() const { return heartbeat_ms_; }

 private:
    Participant() = default;

    eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
    eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
    eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
    std::vector<eprosima::fastdds::dds::Topic*> topics_;
    std::uint32_t heartbeat_ms_ = 20;
    TransportCounts counts_;
    std::mutex mutex_;
    std::set<std::pair<std::string, int>> told_incompatible_;
};

}  // namespace pursuit
