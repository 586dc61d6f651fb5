// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/recording_file.hpp"

#include "services/recorder/mcap/schema_text.hpp"
#include "services/recorder/record/related_sample.hpp"

namespace pursuit::recorder {

Result<RecordingFile> RecordingFile::create(std::unique_ptr<mcap::Output> output,
                                            const std::string& path,
                                            const mcap::WriterOptions& options, std::int64_t now_us,
                                            const std::vector<TopicFacts>& topics,
                                            Discovered discovered) {
    auto writer = mcap::Writer::create(std::move(output), options, now_us);
    if (!writer) return tl::unexpected(writer.error());
    return RecordingFile(path, std::move(*writer), topics, std::move(discovered));
}

Result<std::uint16_t> RecordingFile::channel(const Sample& sample, Side side) {
    const ChannelKey key{sample.topic, sample.id.writer, side};
    if (const auto known = channels_.find(key); known != channels_.end()) return known->second;

    const auto& topic = (*topics_)[sample.topic];
    const auto offered = discovered_(topic, sample.id.writer);
    mcap::ReplayFacts facts;
    facts.type_name = topic.type_name;
    facts.keyed = topic.keyed;
    facts.partitions = offered.partitions;
    facts.reliability = offered.reliability;
    facts.durability = offered.durability;
    facts.history_depth = topic.history_depth;
    facts.ownership = offered.ownership;
    facts.deadline_ns = offered.deadline_ns;
    facts.writer_guid = to_hex(sample.id.writer);
    auto metadata = mcap::to_metadata(facts);
    metadata["pursuit.flow"] = topic.flow;

    std::uint16_t schema = 0;
    if (side == Side::samples) {
        auto added = writer_.add_schema(topic.type_name, mcap::schema_encoding,
                                        mcap::schema_text(topic.type_name));
        if (!added) return added;
        schema = *added;
    }
    const auto encoding = side == Side::samples           ? mcap::message_encoding
                          : side == Side::instance_states ? mcap::instance_state_encoding
                                                          : related_sample_encoding;
    auto added = writer_.add_channel(schema, topic.name, encoding, metadata);
    if (added) channels_.emplace(key, *added);
    return added;
}

Result<void> RecordingFile::write(const Sample& sample) {
    const auto side = sample.kind == SampleKind::data ? Side::samples : Side::instance_states;
    const auto id = channel(sample, side);
    if (!id) return tl::unexpected(id.error());
    mcap::MessageHead head{*id, static_cast<std::uint32_t>(sample.id.sequence),
                           sample.reception_time_ns, sample.source_time_ns};
    if (side == Side::instance_states) {
        mcap::InstanceState state;
        state.disposed = sample.kind == SampleKind::disposed;
        state.unregistered = sample.kind == SampleKind::unregistered;
        state.key_hash = sample.instance;
        return writer_.write(head, mcap::encode(state));
    }
    if (auto ok = writer_.write(head, sample.payload); !ok) return ok;
    if (sample.related.sequence <= 0) return {};
    const auto beside = channel(sample, Side::related_samples);
    if (!beside) return tl::unexpected(beside.error());
    head.channel_id = *beside;
    return writer_.write(head, encode_related(sample.related));
}

}  // namespace pursuit::recorder
