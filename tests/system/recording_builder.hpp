// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "services/recorder/record/file_sequence.hpp"
#include "tests/system/recorder_fixture.hpp"

namespace pursuit::testing {

/// Writes recordings; times in ms after start_ns.
class RecordingBuilder {
 public:
    static constexpr std::int64_t start_ns = 1'700'000'000'000'000'000;

    RecordingBuilder(const std::string& path, std::vector<const char*> names) {
        for (const auto* name : names) {
            topics_.push_back(recorder::facts_of(*recorder::find_raw_topic(name)));
        }
        files_ = std::make_unique<recorder::FileSequence>(
            recorder::FileOptions{path, {}, 0}, topics_,
            [](auto&, auto&) { return recorder::OfferedQos{}; },
            [](const std::string& error) { FAIL() << error; });
        EXPECT_TRUE(files_->begin({}));
    }

    void add(const char* topic, int at_ms, recorder::Payload payload) {
        recorder::Sample sample;
        while (topics_[sample.topic].name != topic) ++sample.topic;
        sample.id.writer.fill(static_cast<std::uint8_t>(0x50 + sample.topic));
        sample.id.sequence = ++sequence_;
        sample.reception_time_ns = start_ns + at_ms * std::int64_t{1'000'000};
        sample.source_time_ns = sample.reception_time_ns - 1000;
        sample.payload = std::move(payload);
        files_->write(sample, {});
    }
    void add_packets(int count) {
        for (int i = 0; i < count; ++i) {
            add(topic::events, i, serialized(packet_number(static_cast<std::uint64_t>(i), 77)));
        }
    }
    /// A request and its reply, as the tracker gave it.
    void add_call(int at_ms, v1::TrackerRequest request, std::int64_t effective_us,
                  v1::StatusCode code = v1::STATUS_OK) {
        request.header().request_id().sequence_low(++calls_);
        v1::TrackerReply reply;
        reply.header().related_request_id(request.header().request_id());
        reply.header().instance_name("default");
        reply.effective_time_us(effective_us);
        reply.outcome().code(code);
        if (request.call()._d() == v1::TRACKER_REGISTER_MODEL) {
            v1::RegisterModelResult result;
            result.object_id(7);
            reply.result().register_model(result);
        } else {
            reply.result().remove_model({});
        }
        add(topic::tracker_request, at_ms, serialized(request));
        add(topic::tracker_reply, at_ms + 1, serialized(reply));
    }
    void close() { files_->close({}); }

 private:
    std::vector<recorder::TopicFacts> topics_;
    std::unique_ptr<recorder::FileSequence> files_;
    std::int64_t sequence_ = 0;
    std::uint32_t calls_ = 0;
};

}  // namespace pursuit::testing
