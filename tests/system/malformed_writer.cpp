// SPDX-License-Identifier: Apache-2.0
// Sends samples that no generated writer would: cut short, with wrong encapsulation, absurd lengths
// and random bytes, under the names of real types. Prints how many.
//
//   malformed_writer DOMAIN
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fastdds/dds/core/status/PublicationMatchedStatus.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <thread>
#include <utility>

#include "services/common/participant.hpp"
#include "services/common/qos.hpp"
#include "services/common/topics.hpp"
#include "tests/system/raw_samples.hpp"

using pursuit::testing::malformed_samples;
using pursuit::testing::RawType;

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    pursuit::disk::Dds settings;
    settings.set_domain(static_cast<std::uint32_t>(std::atoi(argv[1])));
    settings.set_loopback_only(true);
    auto participant = pursuit::Participant::create(settings, "malformed", "");
    if (!participant) return 1;
    const std::pair<const char*, const char*> targets[] = {
        {pursuit::topic::events, "pursuit::v1::EventPacket"},
        {pursuit::topic::tracker_request, "pursuit::v1::TrackerRequest"}};
    int sent = 0;
    for (const auto& [topic_name, type_name] : targets) {
        auto topic =
            (*participant)
                ->topic(topic_name, eprosima::fastdds::dds::TypeSupport(new RawType(type_name)));
        if (!topic) return 1;
        auto qos = pursuit::writer_qos(pursuit::flow_of(topic_name), 20);
        qos.endpoint().history_memory_policy =
            eprosima::fastrtps::rtps::DYNAMIC_RESERVE_MEMORY_MODE;
        auto* writer = (*participant)->publisher().create_datawriter(*topic, qos);
        if (writer == nullptr) return 1;
        eprosima::fastdds::dds::PublicationMatchedStatus matched;
        for (int i = 0; i < 1000 && matched.current_count == 0; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            writer->get_publication_matched_status(matched);
        }
        if (matched.current_count == 0) {
            std::fprintf(stderr, "nobody reads %s\n", topic_name);
            return 1;
        }
        for (auto& sample : malformed_samples()) {
            if (!writer->write(&sample)) return 1;
            ++sent;
        }
        writer->wait_for_acknowledgments({2, 0});
    }
    std::printf("%d malformed samples sent\n", sent);
    return 0;
}
