// SPDX-License-Identifier: Apache-2.0
// What the QoS of a topic is worth on a link that loses one packet in ten.
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/test_UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

#include "services/common/guarded_type.hpp"
#include "services/common/qos.hpp"
#include "services/common/topics.hpp"
#include "tests/system/free_domain.hpp"
#include "tests/system/real_traffic.hpp"

namespace pursuit {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastdds::rtps;
using namespace std::chrono_literals;

constexpr std::uint32_t heartbeat_ms = 20;

/// Loses every tenth message with data that it sends, those of discovery included.
std::shared_ptr<rtps::TransportDescriptorInterface> lossy_transport(std::atomic<int>& lost) {
    auto transport = std::make_shared<rtps::test_UDPv4TransportDescriptor>();
    transport->drop_data_messages_filter_ =
        [&lost, sent = 0](eprosima::fastrtps::rtps::CDRMessage_t&) mutable {
            const bool is_lost = ++sent % 10 == 0;
            if (is_lost) ++lost;
            return is_lost;
        };
    return transport;
}

class Participant {
 public:
    Participant(std::uint32_t domain,
                std::shared_ptr<rtps::TransportDescriptorInterface> transport) {
        dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
        eprosima::fastrtps::rtps::Locator_t loopback;
        loopback.kind = LOCATOR_KIND_UDPv4;
        eprosima::fastrtps::rtps::IPLocator::setIPv4(loopback, "127.0.0.1");
        qos.transport().use_builtin_transports = false;
        qos.transport().user_transports.push_back(std::move(transport));
        qos.wire_protocol().builtin.initialPeersList.push_back(loopback);
        qos.wire_protocol().builtin.metatrafficUnicastLocatorList.push_back(loopback);
        qos.wire_protocol().default_unicast_locator_list.push_back(loopback);
        participant_ =
            dds::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
        dds::TypeSupport type(new GuardedType<v1::ObjectPose>(malformed_));
        type.register_type(participant_);
        topic_ =
            participant_->create_topic(topic::poses, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
    }
    ~Participant() {
        participant_->delete_contained_entities();
        dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
    }
    Participant(const Participant&) = delete;
    Participant& operator=(const Participant&) = delete;

    dds::DomainParticipant& operator*() { return *participant_; }
    dds::Topic* poses() { return topic_; }

 private:
    std::shared_ptr<std::atomic<std::uint64_t>> malformed_ =
        std::make_shared<std::atomic<std::uint64_t>>(0);
    dds::DomainParticipant* participant_ = nullptr;
    dds::Topic* topic_ = nullptr;
};

/// The numbers of the poses that came.
class Arrivals : public dds::DataReaderListener {
 public:
    void on_data_available(dds::DataReader* reader) override {
        v1::ObjectPose pose;
        dds::SampleInfo info;
        while (reader->take_next_sample(&pose, &info) ==
               eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
            if (!info.valid_data) continue;
            const std::scoped_lock lock(mutex_);
            numbers_.insert(pose.sequence_number());
        }
    }
    std::set<std::uint64_t> numbers() const {
        const std::scoped_lock lock(mutex_);
        return numbers_;
    }

 private:
    mutable std::mutex mutex_;
    std::set<std::uint64_t> numbers_;
};

bool eventually(const std::function<bool()>& condition) {
    for (int i = 0; i < 1000; ++i) {
        if (condition()) return true;
        std::this_thread::sleep_for(5ms);
    }
    return false;
}

TEST(LossyLink, every_pose_of_an_object_arrives_though_one_message_in_ten_is_lost) {
    testing::deliver_over_sockets();
    const testing::FreeDomain domain;
    const auto number = domain.settings().domain();
    std::atomic<int> lost{0};
    Arrivals arrivals;
    Participant far(number, std::make_shared<rtps::UDPv4TransportDescriptor>());
    Participant near(number, lossy_transport(lost));
    auto* subscriber = (*far).create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    ASSERT_NE(subscriber->create_datareader(far.poses(), reader_qos(Flow::poses), &arrivals),
              nullptr);
    auto* publisher = (*near).create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    auto* writer =
        publisher->create_datawriter(near.poses(), writer_qos(Flow::poses, heartbeat_ms));
    ASSERT_NE(writer, nullptr);
    ASSERT_TRUE(eventually([&] {
        dds::PublicationMatchedStatus status;
        writer->get_publication_matched_status(status);
        return status.current_count == 1;
    }));

    constexpr std::uint64_t poses = 400;
    v1::ObjectPose pose;
    pose.object_id(1);
    const int lost_before = lost;
    for (std::uint64_t i = 1; i <= poses; ++i) {
        pose.sequence_number(i);
        ASSERT_TRUE(writer->write(&pose));
        std::this_thread::sleep_for(5ms);
    }
    EXPECT_TRUE(eventually([&] { return arrivals.numbers().size() == poses; }))
        << poses - arrivals.numbers().size() << " never came";
    EXPECT_GE(lost - lost_before, static_cast<int>(poses / 10));
}

}  // namespace
}  // namespace pursuit
