// SPDX-License-Identifier: Apache-2.0
// Sends samples that no generated writer would: cut short, with wrong encapsulation, absurd lengths
// and random bytes, under the names of real types. Prints how many.
//
//   malformed_writer DOMAIN
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fastdds/dds/core/status/PublicationMatchedStatus.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <random>
#include <thread>
#include <vector>

#include "services/common/participant.hpp"
#include "services/common/qos.hpp"
#include "services/common/topics.hpp"

namespace {

using Bytes = std::vector<unsigned char>;

/// A type that is nothing but its bytes.
class RawType : public eprosima::fastdds::dds::TopicDataType {
 public:
    explicit RawType(const char* name) {
        setName(name);
        m_typeSize = 70000;
        m_isGetKeyDefined = false;
        auto_fill_type_information(false);
        auto_fill_type_object(false);
    }
    bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override {
        const auto& bytes = *static_cast<Bytes*>(data);
        std::memcpy(payload->data, bytes.data(), bytes.size());
        payload->length = static_cast<std::uint32_t>(bytes.size());
        return true;
    }
    bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t*, void*) override {
        return false;
    }
    std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
        return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size()); };
    }
    void* createData() override { return new Bytes; }
    void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
    bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

std::vector<Bytes> malformed_samples() {
    std::vector<Bytes> samples{
        {0, 1, 0},                             // shorter than the encapsulation
        {0, 1, 0, 0},                          // nothing behind it
        {0, 1, 0, 0, 1},                       // cut within the first field
        {0, 7, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8},  // an encapsulation that is not plain CDR
        Bytes(64, 0xff),
    };
    std::mt19937 random(1);
    for (int i = 0; i < 20; ++i) {
        Bytes bytes(8 + random() % 200);
        for (auto& byte : bytes) byte = static_cast<unsigned char>(0x80 | random());
        bytes[0] = 0;
        bytes[1] = static_cast<unsigned char>(2 + random() % 250);  // never a known encapsulation
        samples.push_back(bytes);
    }
    return samples;
}

}  // namespace

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
