// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "services/recorder/mcap/reader.hpp"
#include "services/recorder/record/file_sequence.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/recorder/mcap_sample.hpp"
#include "tests/unit/recorder/packet_payload.hpp"

namespace pursuit::recorder {

/// A FileSequence in a folder of the test's own, and what goes into it.
class Files : public ::testing::Test {
 protected:
    FileSequence sequence(FileOptions options) {
        return FileSequence(
            std::move(options), topics_,
            [this](auto&, const Guid& writer) {
                OfferedQos offered;
                offered.gone = gone_.contains(writer);
                return offered;
            },
            [this](const std::string& error) { errors_.push_back(error); });
    }
    static Sample sample(std::uint8_t content, std::size_t topic = 0, std::uint8_t writer = 1) {
        Sample sample;
        sample.topic = topic;
        sample.id.writer.fill(writer);
        sample.id.sequence = content;
        sample.reception_time_ns = 1000 + content;
        sample.payload = {0, 1, 0, 0, content};
        return sample;
    }
    static Sample model(std::uint8_t instance, std::uint8_t content, std::uint8_t writer = 1) {
        auto model = sample(content, 2, writer);
        model.instance.fill(instance);
        model.source_time_ns = 100 + content;
        return model;
    }
    struct Message {
        mcap::MessageHead head;
        mcap::Channel channel;
        mcap::Bytes data;
    };
    static std::vector<Message> messages(const std::string& path) {
        std::vector<Message> found;
        auto input = mcap::FileInput::open(path);
        if (!input) return found;
        auto reader = mcap::Reader::open(std::move(*input), path);
        while (reader) {
            const auto message = reader->next();
            if (!message || !*message) break;
            found.push_back({(*message)->head,
                             *(*message)->channel,
                             {(*message)->data.begin(), (*message)->data.end()}});
        }
        return found;
    }
    static Sample packet(std::uint64_t sequence_number) {
        v1::EventPacket fields;
        fields.stream_id(1);
        fields.sequence_number(sequence_number);
        auto packet = sample(0, 3);
        packet.payload = packet_payload(fields);
        return packet;
    }
    /// A file on `disk`, and one of 100 bytes by its name in the folder.
    static FileOptions::Create on(const std::shared_ptr<mcap::MemoryOutput::Disk>& disk) {
        return [disk](const std::string& path) {
            std::ofstream(path) << std::string(100, ' ');
            return std::make_unique<mcap::MemoryOutput>(disk);
        };
    }
    std::string path(const std::string& name) const { return folder_.path(name); }

    test::TemporaryFolder folder_;
    std::vector<TopicFacts> topics_ = {
        {"pursuit/poses", "pursuit::v1::ObjectPose", true, "poses", 16},
        {"pursuit/tracker/reply", "pursuit::v1::TrackerReply", false, "calls", 128},
        {"pursuit/models", "pursuit::v1::RegisteredModel", true, "latched", 1},
        {"pursuit/events", "pursuit::v1::EventPacket", false, "events", 64}};
    std::set<Guid> gone_;
    std::vector<std::string> errors_;
};

}  // namespace pursuit::recorder
