// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/recorder/mcap/writer.hpp"
#include "services/recorder/record/recorded_topic.hpp"
#include "services/recorder/record/sample.hpp"

namespace pursuit::recorder {

/// One MCAP file of samples. Each writer of a topic has a channel of its own, which says how the
/// writer offered the topic and who it is; with the message's sequence (its low 32 bits) that is
/// the sample's identity. Two kinds of side channels have the same topic and metadata and no
/// schema:
///   pursuit.instance_state.v1    disposes and unregistrations (mcap/facts.hpp)
///   pursuit.related_sample.v1    beside a reply that carries it: which request it answers.
///                                16 octets of GUID, then 8 of sequence, little-endian; log time
///                                and sequence are the reply's.
/// One thread.
class RecordingFile {
 public:
    /// What a writer offered, from its GUID.
    using Discovered = std::function<OfferedQos(const TopicFacts&, const Guid&)>;

    /// `path` is for messages.
    static Result<RecordingFile> create(std::unique_ptr<mcap::Output> output,
                                        const std::string& path, const mcap::WriterOptions& options,
                                        std::int64_t now_us, const std::vector<TopicFacts>& topics,
                                        Discovered discovered);

    Result<void> write(const Sample& sample);
    Result<void> tick(std::int64_t now_us) { return writer_.tick(now_us); }
    Result<void> flush() { return writer_.flush(); }
    Result<void> close() { return writer_.close(); }

    const std::string& path() const { return path_; }
    const mcap::WriterTotals& totals() const { return writer_.totals(); }
    std::uint64_t bytes() const { return totals().bytes + totals().open_chunk_bytes; }

    /// A bound of the format or of memory is near: the recording should go on in a new file.
    bool full() const { return writer_.index_full() || channels_.size() >= most_channels; }

    static constexpr std::size_t most_channels = 2000;

 private:
    enum class Side : std::uint8_t { samples, instance_states, related_samples };
    struct ChannelKey {
        std::size_t topic;
        Guid writer;
        Side side;
        auto operator<=>(const ChannelKey&) const = default;
    };

    RecordingFile(std::string path, mcap::Writer writer, const std::vector<TopicFacts>& topics,
                  Discovered discovered)
        : path_(std::move(path)),
          writer_(std::move(writer)),
          topics_(&topics),
          discovered_(std::move(discovered)) {}

    Result<std::uint16_t> channel(const Sample& sample, Side side);

    std::string path_;
    mcap::Writer writer_;
    const std::vector<TopicFacts>* topics_;
    Discovered discovered_;
    std::map<ChannelKey, std::uint16_t> channels_;
};

}  // namespace pursuit::recorder
