// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/record_activity.hpp"

#include <spdlog/spdlog.h>

namespace pursuit::recorder {

namespace dds = eprosima::fastdds::dds;

namespace {

/// A stop may take 2 s in all; closing the file needs the rest.
constexpr auto drain_at_most = std::chrono::milliseconds(1000);

mcap::WriterOptions writer_options(const disk::RecorderConfig& configuration) {
    mcap::WriterOptions options;
    options.compression = configuration.compression() == disk::RecorderConfig::NONE
                              ? mcap::Compression::none
                              : mcap::Compression::zstd;
    options.chunk_bytes = configuration.chunk_bytes();
    options.chunk_age_us = std::int64_t{configuration.chunk_ms()} * 1000;
    options.library = std::string("pursuit-recorder ") + version();
    return options;
}

std::vector<const RawTopic*> chosen_topics(const disk::RecorderConfig& configuration) {
    std::vector<const RawTopic*> chosen;
    for (const auto& topic : raw_topics()) {
        const auto& wanted = configuration.topic();
        if (wanted.empty() || std::find(wanted.begin(), wanted.end(), topic.name) != wanted.end()) {
            chosen.push_back(&topic);
        }
    }
    return chosen;
}

}  // namespace

RecordActivity::RecordActivity(const disk::RecorderConfig& configuration, Health& health)
    : configuration_(configuration), health_(health) {}

RecordActivity::~RecordActivity() { stop(); }

Result<void> RecordActivity::start() {
    const auto topics = chosen_topics(configuration_);
    std::vector<TopicFacts> facts;
    for (const auto* topic : topics) facts.push_back(facts_of(*topic));
    auto recording = Recording::start(
        {configuration_.output(), writer_options(configuration_), configuration_.max_file_bytes()},
        configuration_.queue_bytes(), std::move(facts),
        [this](const TopicFacts& topic, const Guid& writer) { return offered(topic, writer); },
        [this](const std::string& error) { health_.error(error); });
    if (!recording) return tl::unexpected(recording.error());
    recording_ = std::move(*recording);

    auto participant = Participant::create(configuration_.dds(), "pursuit-recorder/samples",
                                           configuration_.name());
    if (!participant) return tl::unexpected(participant.error());
    participant_ = std::move(*participant);
    participant_->dds().set_listener(&writers_, dds::StatusMask::none());

    // Sensors and trackers offer the default partition too: to hear one of several, only its own.
    auto* of_the_sensor = &participant_->subscriber();
    if (!configuration_.name().empty()) {
        dds::SubscriberQos qos = dds::SUBSCRIBER_QOS_DEFAULT;
        qos.partition().push_back(configuration_.name().c_str());
        of_the_sensor = participant_->dds().create_subscriber(qos);
        if (of_the_sensor == nullptr) return fail("cannot create a DDS subscriber");
    }
    for (std::size_t i = 0; i < topics.size(); ++i) {
        // Clients call from the default partition.
        auto& subscriber =
            topics[i]->flow == Flow::calls ? participant_->subscriber() : *of_the_sensor;
        auto reader = RawReader::create(*participant_, subscriber, *topics[i], i, *recording_);
        if (!reader) return tl::unexpected(reader.error());
        readers_.push_back(std::move(*reader));
    }
    spdlog::info("{} topics: {}", topics.size(), status_line());
    return {};
}

OfferedQos RecordActivity::offered(const TopicFacts& topic, const Guid& writer) const {
    if (auto found = writers_.find(writer)) return *found;
    // Not seen by discovery, which should not be: what this topic's writers offer by design.
    OfferedQos offered;
    const auto qos = writer_qos(flow_of(topic.name.c_str()), configuration_.dds().heartbeat_ms());
    offered.durability = qos.durability().kind == dds::VOLATILE_DURABILITY_QOS
                             ? mcap::Durability::volatile_
                             : mcap::Durability::transient_local;
    return offered;
}

void RecordActivity::stop() {
    readers_.clear();
    if (participant_) participant_->dds().set_listener(nullptr);
    participant_.reset();
    if (recording_) recording_->stop(drain_at_most);
}

bool RecordActivity::failed() const {
    return recording_ && !recording_->figures().files.fault.empty();
}

std::string RecordActivity::status_line() const {
    if (!recording_) return "starts";
    const auto figures = recording_->figures();
    if (!figures.files.fault.empty()) return "cannot record: " + figures.files.fault;
    return (recording_->paused() ? "paused, " : "records to ") + figures.files.file;
}

v1::ServiceState RecordActivity::state() const {
    if (!recording_) return v1::SERVICE_STARTING;
    if (!recording_->figures().files.fault.empty()) return v1::SERVICE_FAULT;
    return recording_->paused() ? v1::SERVICE_PAUSED : v1::SERVICE_RUNNING;
}

std::uint64_t RecordActivity::changes() const {
    return own_changes_ + (recording_ ? recording_->figures().files.changes : 0);
}

void RecordActivity::fill(v1::RecorderStatus& status) const {
    status.replaying(false);
    if (!recording_) return;
    const auto figures = recording_->figures();
    const auto& files = figures.files;
    status.file(bounded(files.file, 255));
    status.bytes_written(files.bytes_written);
    status.chunks_written(files.chunks_written);
    status.last_flush_host_time_ns(files.last_flush_host_ns);
    status.messages(files.messages);
    std::uint64_t dropped = 0;
    for (std::size_t i = 0; i < drop_causes.size(); ++i) {
        v1::NamedCount count;
        count.name(to_string(drop_causes[i]));
        count.count(figures.dropped[i]);
        status.dropped_by().push_back(count);
        dropped += figures.dropped[i];
    }
    status.messages_dropped(dropped);
    status.queue_bytes(static_cast<std::uint32_t>(figures.queue_bytes));
    status.queue_capacity_bytes(configuration_.queue_bytes());
    status.gaps(files.gaps);
    for (std::size_t i = 0; i < recording_->topics().size(); ++i) {
        v1::RecorderTopic topic;
        topic.topic(recording_->topics()[i].name);
        topic.messages(files.topics[i].messages);
        topic.bytes(files.topics[i].bytes);
        topic.lost(figures.topics_lost[i]);
        status.topics().push_back(topic);
    }
    if (participant_) {
        const auto& counts = participant_->counts();
        auto& health = status.health();
        health.lost_samples(health.lost_samples() + counts.lost.load() + counts.rejected.load());
        count_peers(counts, status.dropped_by());
    }
}

Result<void> RecordActivity::pause(bool paused) {
    if (recording_->paused() != paused) ++own_changes_;
    recording_->pause(paused);
    return {};
}

Result<void> RecordActivity::set_rate(double) {
    return fail("rate: only a replay has one; this recorder records");
}

void RecordActivity::new_file(Done done) {
    recording_->new_file([done = std::move(done)](const Result<std::string>& path) {
        if (path) {
            done(v1::STATUS_OK, "");
        } else {
            done(v1::STATUS_FAILED, path.error().message);
        }
    });
}

}  // namespace pursuit::recorder
