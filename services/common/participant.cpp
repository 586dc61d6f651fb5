// SPDX-License-Identifier: Apache-2.0
#include "services/common/participant.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>

#include <spdlog/spdlog.h>

#include "services/common/qos.hpp"

namespace pursuit {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastdds::rtps;

namespace {

/// Unicast discovery asks this many participant ports of each peer; the default of 4 keeps the
/// fifth process of a host from being found.
constexpr std::uint32_t participants_per_peer = 40;

dds::DomainParticipantQos participant_qos(const disk::Dds& settings, const std::string& name) {
    dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
    qos.name(name);
    auto& discovery = qos.wire_protocol().builtin.discovery_config;
    discovery.leaseDuration = {5, 0};
    // A participant answers a newcomer once; where that answer comes before the newcomer listens,
    // the next periodic announcement is what it hears. So this period bounds how late a restarted
    // service is found again.
    discovery.leaseDuration_announcementperiod = {0, 250'000'000};
    discovery.initial_announcements.count = 10;
    discovery.initial_announcements.period = {0, 50'000'000};

    qos.transport().use_builtin_transports = false;
    auto udp = std::make_shared<rtps::UDPv4TransportDescriptor>();
    udp->sendBufferSize = settings.socket_buffer_bytes();
    udp->receiveBufferSize = settings.socket_buffer_bytes();
    udp->maxInitialPeersRange = participants_per_peer;
    if (settings.loopback_only()) udp->interfaceWhiteList = {"127.0.0.1"};
    qos.transport().user_transports.push_back(udp);
    if (settings.shared_memory()) {
        auto shared = std::make_shared<rtps::SharedMemTransportDescriptor>();
        shared->maxInitialPeersRange = participants_per_peer;
        qos.transport().user_transports.push_back(shared);
    }

    std::vector<std::string> peers(settings.initial_peer().begin(), settings.initial_peer().end());
    if (settings.loopback_only()) peers.emplace_back("127.0.0.1");
    for (const auto& peer : peers) {
        eprosima::fastrtps::rtps::Locator_t locator;
        locator.kind = LOCATOR_KIND_UDPv4;
        eprosima::fastrtps::rtps::IPLocator::setIPv4(locator, peer);
        qos.wire_protocol().builtin.initialPeersList.push_back(locator);
    }
    if (settings.loopback_only()) {
        // Discovery by unicast only: not every loopback interface passes multicast on.
        eprosima::fastrtps::rtps::Locator_t loopback;
        loopback.kind = LOCATOR_KIND_UDPv4;
        eprosima::fastrtps::rtps::IPLocator::setIPv4(loopback, "127.0.0.1");
        qos.wire_protocol().builtin.metatrafficUnicastLocatorList.push_back(loopback);
    }
    return qos;
}

}  // namespace

Result<void> Participant::check(const disk::Dds& settings) {
    for (int i = 0; i < settings.initial_peer_size(); ++i) {
        const auto& peer = settings.initial_peer(i);
        if (!eprosima::fastrtps::rtps::IPLocator::isIPv4(peer)) {
            return fail_field("dds.initial_peer[" + std::to_string(i) + "]",
                              ": \"" + peer + "\" is no IPv4 address");
        }
    }
    return {};
}

Result<std::unique_ptr<Participant>> Participant::create(const disk::Dds& settings,
                                                         const std::string& name,
                                                         const std::string& sensor) {
    if (auto good = check(settings); !good) return tl::unexpected(good.error());
    std::unique_ptr<Participant> self(new Participant);
    self->heartbeat_ms_ = settings.heartbeat_ms();
    auto* factory = dds::DomainParticipantFactory::get_instance();
    self->participant_ =
        factory->create_participant(settings.domain(), participant_qos(settings, name));
    if (self->participant_ == nullptr) {
        return fail("cannot join DDS domain " + std::to_string(settings.domain()));
    }
    dds::PublisherQos publisher_qos = dds::PUBLISHER_QOS_DEFAULT;
    dds::SubscriberQos subscriber_qos = dds::SUBSCRIBER_QOS_DEFAULT;
    if (!sensor.empty()) {
        // The default partition too: a writer only in a named one is invisible to plain readers.
        for (const auto* partition : {"", sensor.c_str()}) {
            publisher_qos.partition().push_back(partition);
            subscriber_qos.partition().push_back(partition);
        }
    }
    self->publisher_ = self->participant_->create_publisher(publisher_qos);
    self->subscriber_ = self->participant_->create_subscriber(subscriber_qos);
    if (self->publisher_ == nullptr || self->subscriber_ == nullptr) {
        return fail("cannot create a DDS publisher and subscriber");
    }
    return self;
}

Participant::~Participant() {
    if (participant_ == nullptr) return;
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

void Participant::incompatible(const std::string& topic, dds::QosPolicyId_t policy) {
    counts_.incompatible.fetch_add(1);
    const std::scoped_lock lock(mutex_);
    if (!told_incompatible_.emplace(topic, policy).second) return;
    spdlog::warn(
        "{}: a peer's {} does not fit ours, so that nothing passes between it and us "
        "(idl/README.md, Topics)",
        topic, policy_name(policy));
}

Result<dds::Topic*> Participant::topic(const std::string& name, dds::TypeSupport type) {
    for (auto* known : topics_) {
        if (known->get_name() == name) return known;
    }
    if (type.register_type(participant_) != eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
        return fail("cannot register the DDS type " + type.get_type_name());
    }
    auto* made = participant_->create_topic(name, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
    if (made == nullptr) return fail("cannot create the DDS topic " + name);
    topics_.push_back(made);
    return made;
}

}  // namespace pursuit
