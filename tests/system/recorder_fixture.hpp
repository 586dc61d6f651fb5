// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "services/common/request_client.hpp"
#include "services/recorder/mcap/reader.hpp"
#include "services/recorder/replay/raw_writer.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/system/child_process.hpp"
#include "tests/system/free_domain.hpp"

namespace pursuit::testing {

/// A message of a recording, in memory.
struct FileMessage {
    recorder::mcap::MessageHead head;
    recorder::mcap::Channel channel;
    std::vector<std::uint8_t> data;
};

struct FileContent {
    std::vector<FileMessage> messages;
    recorder::mcap::Condition condition = recorder::mcap::Condition::reading;
    std::string error;

    /// Payloads of one topic, in order.
    std::vector<recorder::Payload> payloads(const std::string& topic) const {
        std::vector<recorder::Payload> found;
        for (const auto& message : messages) {
            if (message.channel.topic == topic && message.channel.message_encoding == "cdr") {
                found.push_back(message.data);
            }
        }
        return found;
    }
};

inline FileContent read_recording(const std::string& path) {
    using namespace recorder::mcap;
    FileContent content;
    auto input = FileInput::open(path);
    if (!input) return content.error = input.error().message, content;
    auto reader = recorder::mcap::Reader::open(std::move(*input), path);
    if (!reader) return content.error = reader.error().message, content;
    while (true) {
        auto message = reader->next();
        if (!message) {
            content.error = message.error().message;
            break;
        }
        if (!*message) break;
        const auto& view = **message;
        content.messages.push_back(
            {view.head, *view.channel, {view.data.begin(), view.data.end()}});
    }
    content.condition = reader->condition();
    return content;
}

/// `sample` serialized as its writer would, every octet of padding zero.
template <class T>
recorder::Payload serialized(T sample) {
    typename Wire<T>::Support type;
    eprosima::fastrtps::rtps::SerializedPayload_t buffer(type.getSerializedSizeProvider(&sample)());
    std::fill_n(buffer.data, buffer.max_size, std::uint8_t{0});
    EXPECT_TRUE(type.serialize(&sample, &buffer));
    return {buffer.data, buffer.data + buffer.length};
}

template <class T>
T deserialized(recorder::Payload payload) {
    typename Wire<T>::Support type;
    eprosima::fastrtps::rtps::SerializedPayload_t view;
    view.data = payload.data();
    view.length = view.max_size = static_cast<std::uint32_t>(payload.size());
    T sample;
    EXPECT_TRUE(type.deserialize(&view, &sample));
    view.data = nullptr;
    return sample;
}

/// A packet of `events` events, 1 µs apart, whose content follows from its number.
inline v1::EventPacket packet_number(std::uint64_t number, std::uint64_t stream_id,
                                     std::uint32_t events = 200) {
    v1::EventPacket packet;
    packet.sensor_id(1);
    packet.stream_id(stream_id);
    packet.sequence_number(number);
    packet.base_time_us(static_cast<std::int64_t>(number) * 1000);
    packet.host_time_ns(1'700'000'000'000'000'000 + static_cast<std::int64_t>(number) * 1'000'000);
    packet.width(304);
    packet.height(240);
    for (std::uint64_t i = 0; i < events; ++i) {
        packet.words().push_back((i << 32) | ((number * 7 + i) % 304 << 16) | (i % 240 << 1));
    }
    return packet;
}

/// A domain, a folder and a participant; runs the real recorder in them.
class RecorderTest : public ::testing::Test {
 protected:
    RecorderTest() {
        auto made = Participant::create(domain_.settings(), "test", "");
        EXPECT_TRUE(made) << made.error().message;
        participant_ = std::move(*made);
    }
    ~RecorderTest() override {
        if (HasFailure()) folder_.keep();
    }

    std::string path(const std::string& name) const { return folder_.path(name); }

    /// A recorder with field=value settings.
    std::unique_ptr<ChildProcess> recorder(
        std::vector<std::string> settings, const std::function<void()>& prepare = [] {}) {
        settings.push_back("dds.loopback_only=true");
        settings.push_back("dds.domain=" + std::to_string(domain_.settings().domain()));
        std::vector<std::string> arguments;
        for (const auto& setting : settings) {
            arguments.insert(arguments.end(), {"--set", setting});
        }
        return std::make_unique<ChildProcess>("pursuit-recorder", arguments, path("log"), prepare);
    }

    std::unique_ptr<recorder::RawWriter> raw_writer(const char* topic) {
        auto made = recorder::RawWriter::create(*participant_, *recorder::find_raw_topic(topic));
        EXPECT_TRUE(made) << made.error().message;
        return std::move(*made);
    }

    FreeDomain domain_;
    test::TemporaryFolder folder_;
    std::unique_ptr<Participant> participant_;
};

}  // namespace pursuit::testing
