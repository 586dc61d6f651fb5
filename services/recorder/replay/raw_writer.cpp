// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/raw_writer.hpp"

#include <algorithm>

#include "services/common/qos.hpp"

namespace pursuit::recorder {

namespace rtps = eprosima::fastrtps::rtps;

namespace {

/// A replay as fast as possible waits for acknowledgements, which answer heartbeats: at the 20 ms
/// of a live sensor it would send 32 packets in that time.
constexpr std::uint32_t heartbeat_at_most_ms = 2;

}  // namespace

Result<std::unique_ptr<RawWriter>> RawWriter::create(Participant& participant,
                                                     const RawTopic& topic) {
    auto made = participant.topic(topic.name, topic.make_type());
    if (!made) return tl::unexpected(made.error());
    std::unique_ptr<RawWriter> self(new RawWriter(participant));
    self->writer_ = participant.publisher().create_datawriter(
        *made, writer_qos(topic.flow, std::min(participant.heartbeat_ms(), heartbeat_at_most_ms)),
        self.get());
    if (self->writer_ == nullptr) return fail(std::string("cannot write the topic ") + topic.name);
    return self;
}

RawWriter::~RawWriter() {
    if (writer_ == nullptr) return;
    writer_->set_listener(nullptr);
    participant_.publisher().delete_datawriter(writer_);
}

bool RawWriter::write(Payload& payload, std::int64_t source_time_ns, const SampleId& original) {
    rtps::WriteParams params;
    if (source_time_ns >= 0) {
        rtps::Time_t time;
        time.from_ns(source_time_ns);
        params.source_timestamp(time);
    }
    if (original.sequence > 0) {
        rtps::GUID_t guid;
        std::copy_n(original.writer.begin(), 12, guid.guidPrefix.value);
        std::copy_n(original.writer.begin() + 12, 4, guid.entityId.value);
        rtps::SampleIdentity identity;
        identity.writer_guid(guid);
        identity.sequence_number({static_cast<std::int32_t>(original.sequence >> 32),
                                  static_cast<std::uint32_t>(original.sequence & 0xffffffff)});
        params.related_sample_identity(identity);
    }
    return writer_->write(&payload, params);
}

bool RawWriter::wait_acknowledged(std::chrono::milliseconds at_most) {
    const auto ns = std::chrono::nanoseconds(at_most).count();
    return writer_->wait_for_acknowledgments({static_cast<std::int32_t>(ns / 1'000'000'000),
                                              static_cast<std::uint32_t>(ns % 1'000'000'000)}) ==
           eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK;
}

}  // namespace pursuit::recorder
