// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "services/recorder/mcap/reader.hpp"
#include "services/recorder/mcap/writer.hpp"

/// Files in memory for the tests of MCAP.
namespace pursuit::recorder::mcap {

/// Keeps what is written, and how much of it was flushed.
class MemoryOutput final : public Output {
 public:
    struct Disk {
        Bytes data;
        std::size_t flushed = 0;
        int writes = 0;
        int flushes = 0;
        int fail_at = -1;            ///< This call (write or flush, from 0) fails, and all after.
        std::size_t partial = 0;     ///< Bytes that the failing write still leaves on the disk.
        bool refused_after = false;  ///< A call came after the failing one.
    };

    explicit MemoryOutput(std::shared_ptr<Disk> disk) : disk_(std::move(disk)) {}

    Result<void> write(ByteSpan data) override {
        if (fails()) {
            const auto part = data.first(std::min(disk_->partial, data.size()));
            disk_->data.insert(disk_->data.end(), part.begin(), part.end());
            return fail("disk: cannot write: No space left on device");
        }
        ++disk_->writes;
        disk_->data.insert(disk_->data.end(), data.begin(), data.end());
        return {};
    }

    Result<void> flush() override {
        if (fails()) return fail("disk: cannot flush: Input/output error");
        ++disk_->flushes;
        disk_->flushed = disk_->data.size();
        return {};
    }

 private:
    bool fails() {
        const int call = calls_++;
        if (disk_->fail_at >= 0 && call > disk_->fail_at) disk_->refused_after = true;
        return disk_->fail_at >= 0 && call >= disk_->fail_at;
    }

    std::shared_ptr<Disk> disk_;
    int calls_ = 0;
};

/// A message as it should come back.
struct Expected {
    std::string topic;
    std::uint32_t sequence = 0;
    std::int64_t log_time_ns = 0;
    std::int64_t publish_time_ns = 0;
    std::string data;

    friend bool operator==(const Expected&, const Expected&) = default;
};

inline Expected expected(const MessageView& view) {
    return {view.channel->topic, view.head.sequence, view.head.log_time_ns,
            view.head.publish_time_ns,
            std::string(reinterpret_cast<const char*>(view.data.data()), view.data.size())};
}

inline ByteSpan as_bytes(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// What a reader gave, and the error it ended with ("" where it ended well).
struct ReadBack {
    std::vector<Expected> messages;
    std::string error;
};

template <class AnyReader>
ReadBack read_all(Result<AnyReader>& reader) {
    ReadBack back;
    if (!reader) {
        back.error = reader.error().message;
        return back;
    }
    for (;;) {
        const auto message = reader->next();
        if (!message) {
            back.error = message.error().message;
            EXPECT_FALSE(reader->next().has_value()) << "the fault must not go away";
            return back;
        }
        if (!*message) return back;
        back.messages.push_back(expected(**message));
    }
}

inline ReadBack read_all(const Bytes& file, ReadLimits limits = {},
                         OnDamage on_damage = OnDamage::stop) {
    auto reader = Reader::open(std::make_unique<MemoryInput>(file), "run.mcap", limits, on_damage);
    return read_all(reader);
}

struct Sample {
    Bytes file;
    std::vector<Expected> messages;
};

/// A file with `channels` channels, `chunks` chunks and `per_chunk` messages in each; the last
/// of several channels appears only in the last chunk.
inline Sample make_sample(Compression compression, int channels, int chunks, int per_chunk) {
    Sample sample;
    const auto disk = std::make_shared<MemoryOutput::Disk>();
    WriterOptions options;
    options.compression = compression;
    auto writer = Writer::create(std::make_unique<MemoryOutput>(disk), options, 0);
    EXPECT_TRUE(writer);
    EXPECT_TRUE(writer->add_metadata({"pursuit.session", {{"host", "here"}}}));
    std::vector<std::uint16_t> ids;
    const auto add_channel = [&] {
        const std::string topic = "topic/" + std::to_string(ids.size());
        const auto schema = writer->add_schema("type_" + std::to_string(ids.size() % 2), "omgidl",
                                               "struct S { long a; };");
        const auto id = writer->add_channel(*schema, topic, "cdr", {{"pursuit.keyed", "true"}});
        EXPECT_TRUE(id);
        ids.push_back(*id);
    };
    const int early = chunks == 1 || channels == 1 ? channels : channels - 1;
    for (int i = 0; i < early; ++i) add_channel();
    std::int64_t time_ns = 1'700'000'000'000'000'000;
    std::uint32_t sequence = 0;
    for (int chunk = 0; chunk < chunks; ++chunk) {
        if (chunk == chunks - 1 && static_cast<int>(ids.size()) < channels) add_channel();
        for (int i = 0; i < per_chunk && !ids.empty(); ++i) {
            const auto id = ids[(sequence + ids.size() - 1) % ids.size()];
            time_ns += 1'000'000;
            std::string data(sequence % 7, 'a');
            data += "message " + std::to_string(sequence);
            EXPECT_TRUE(writer->write({id, sequence, time_ns, time_ns - 5000}, as_bytes(data)));
            sample.messages.push_back(
                {"topic/" + std::to_string(id - 1), sequence, time_ns, time_ns - 5000, data});
            ++sequence;
        }
        EXPECT_TRUE(writer->flush());
    }
    EXPECT_TRUE(writer->close());
    sample.file = disk->data;
    return sample;
}

}  // namespace pursuit::recorder::mcap
