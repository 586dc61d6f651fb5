// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/raw_reader.hpp"

#include <algorithm>
#include <chrono>
#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include "services/recorder/record/writer_registry.hpp"

namespace pursuit::recorder {

namespace dds = eprosima::fastdds::dds;

namespace {

constexpr std::size_t most_writers = 4096;

/// As the tracker reads, RELIABLE. Measured with 1000 packets of 16 kB a second and two busy loops
/// on two cores: nothing lost, where BEST_EFFORT with the kernel's default socket buffer lost 10 of
/// 5000 in one run of three. A recorder that is stopped for 1 s does not show in the tracker's
/// latency either way (KEEP_LAST: the writer does not wait). What it costs: on a host that is
/// overloaded for long (60 MB/s then), a reader that fell behind may hear nothing until the writer
/// pauses; that is counted as lost.
dds::DataReaderQos recording_qos(Flow flow) { return reader_qos(flow); }

std::int64_t host_now_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

SampleId to_id(const eprosima::fastrtps::rtps::SampleIdentity& identity) {
    if (identity == eprosima::fastrtps::rtps::SampleIdentity::unknown()) return {};
    return {to_guid(identity.writer_guid()),
            static_cast<std::int64_t>(identity.sequence_number().to64long())};
}

}  // namespace

RawReader::RawReader(Participant& participant, dds::Subscriber& subscriber, const RawTopic& topic,
                     std::size_t index, Recording& recording)
    : participant_(participant),
      subscriber_(subscriber),
      topic_(topic),
      index_(index),
      recording_(recording),
      made_at_ns_(host_now_ns()) {}

Result<std::unique_ptr<RawReader>> RawReader::create(Participant& participant,
                                                     dds::Subscriber& subscriber,
                                                     const RawTopic& topic, std::size_t index,
                                                     Recording& recording) {
    auto made = participant.topic(topic.name, topic.make_type());
    if (!made) return tl::unexpected(made.error());
    std::unique_ptr<RawReader> self(
        new RawReader(participant, subscriber, topic, index, recording));
    self->reader_ = subscriber.create_datareader(*made, recording_qos(topic.flow), self.get());
    if (self->reader_ == nullptr) return fail(std::string("cannot read the topic ") + topic.name);
    return self;
}

RawReader::~RawReader() {
    if (reader_ == nullptr) return;
    reader_->set_listener(nullptr);
    subscriber_.delete_datareader(reader_);
}

Sample RawReader::to_sample(const dds::SampleInfo& info) {
    Sample sample;
    sample.topic = index_;
    sample.id = to_id(info.sample_identity);
    sample.related = to_id(info.related_sample_identity);
    sample.reception_time_ns = info.reception_timestamp.to_ns();
    sample.source_time_ns = info.source_timestamp.to_ns();
    for (std::size_t i = 0; i < sample.instance.size(); ++i) {
        sample.instance[i] = info.instance_handle.value[i];
    }
    if (info.valid_data) {
        sample.payload = std::move(payload_);
    } else {
        sample.kind = info.instance_state == dds::NOT_ALIVE_DISPOSED_INSTANCE_STATE
                          ? SampleKind::disposed
                          : SampleKind::unregistered;
    }
    return sample;
}

void RawReader::on_data_available(dds::DataReader* reader) {
    dds::SampleInfo info;
    while (reader->take_next_sample(&payload_, &info) ==
           eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
        batch_.push_back(to_sample(info));
    }
    // Of a keyed topic they come instance by instance: back to the order they were sent in.
    std::sort(batch_.begin(), batch_.end(),
              [](const Sample& a, const Sample& b) { return a.id < b.id; });
    for (auto& sample : batch_) {
        look_for_losses(sample);
        recording_.push(std::move(sample));
    }
    batch_.clear();
}

void RawReader::look_for_losses(const Sample& sample) {
    // What a latched writer kept from before our time has holes by design.
    const bool history = topic_.flow == Flow::latched && sample.source_time_ns < made_at_ns_;
    if (last_.size() > most_writers) last_.clear();
    const Last now{sample.id.sequence, history};
    const auto [last, first] = last_.try_emplace(sample.id.writer, now);
    if (first || now.sequence <= last->second.sequence) return;
    const auto missing = now.sequence - last->second.sequence - 1;
    if (missing > 0 && !last->second.history) {
        recording_.lost_in_transport(index_, static_cast<std::uint64_t>(missing));
    }
    last->second = now;
}

void RawReader::on_sample_lost(dds::DataReader*, const dds::SampleLostStatus& status) {
    participant_.counts().lost.fetch_add(static_cast<std::uint64_t>(status.total_count_change));
}

void RawReader::on_sample_rejected(dds::DataReader*,
                                   const eprosima::fastrtps::SampleRejectedStatus& status) {
    participant_.counts().rejected.fetch_add(static_cast<std::uint64_t>(status.total_count_change));
}

void RawReader::on_requested_incompatible_qos(dds::DataReader*,
                                              const dds::RequestedIncompatibleQosStatus& status) {
    participant_.incompatible(topic_.name, status.last_policy_id);
}

}  // namespace pursuit::recorder
