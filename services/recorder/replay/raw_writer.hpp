// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <memory>

#include "services/common/participant.hpp"
#include "services/recorder/raw_type.hpp"
#include "services/recorder/record/sample.hpp"
#include "services/recorder/topic_table.hpp"

namespace pursuit::recorder {

/// Publishes serialized samples of one topic, with the QoS of its flow. Threads: write() by one at
/// a time.
class RawWriter : private eprosima::fastdds::dds::DataWriterListener {
 public:
    static Result<std::unique_ptr<RawWriter>> create(Participant& participant,
                                                     const RawTopic& topic);
    ~RawWriter() override;
    RawWriter(const RawWriter&) = delete;
    RawWriter& operator=(const RawWriter&) = delete;

    /// source_time_ns: told to the readers as the time of writing; negative: now. `original`: the
    /// sample that this one repeats, told as the related sample; its sequence 0: none.
    /// False when the middleware did not take it.
    bool write(Payload& payload, std::int64_t source_time_ns, const SampleId& original);

    /// Waits until every matched reader has acknowledged what was written; false on time-out.
    bool wait_acknowledged(std::chrono::milliseconds at_most);

    int matched() const { return matched_.load(); }

 private:
    explicit RawWriter(Participant& participant) : participant_(participant) {}

    void on_publication_matched(
        eprosima::fastdds::dds::DataWriter*,
        const eprosima::fastdds::dds::PublicationMatchedStatus& status) override {
        matched_.store(status.current_count);
    }
    void on_offered_incompatible_qos(
        eprosima::fastdds::dds::DataWriter* writer,
        const eprosima::fastdds::dds::OfferedIncompatibleQosStatus& status) override {
        participant_.incompatible(writer->get_topic()->get_name(), status.last_policy_id);
    }

    Participant& participant_;
    eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
    std::atomic<int> matched_{0};
};

}  // namespace pursuit::recorder
