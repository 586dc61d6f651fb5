// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "services/recorder/replay/raw_writer.hpp"
#include "status.h"

namespace pursuit::recorder {

/// A topic that is replayed: its writer, and its running totals. Threads: totals() any,
/// the rest by one at a time.
class ReplayChannel {
 public:
    ReplayChannel(std::string topic, std::unique_ptr<RawWriter> writer)
        : topic_(std::move(topic)), writer_(std::move(writer)) {}

    const std::string& topic() const { return topic_; }

    /// How many readers there are.
    int matched() const { return writer_->matched(); }

    /// As RawWriter::write(), and counts it.
    bool write(Payload& payload, std::int64_t source_time_ns, const SampleId& original);

    /// How many messages may not have reached every reader, at most: those written since
    /// forget_unacknowledged().
    std::size_t unacknowledged() const { return unacknowledged_; }
    void forget_unacknowledged() { unacknowledged_ = 0; }

    /// Waits until every reader has everything; false on time-out.
    bool wait_acknowledged(std::chrono::milliseconds at_most) {
        return writer_->wait_acknowledged(at_most);
    }

    /// Ends the writer; the totals stay.
    void close() { writer_.reset(); }

    v1::RecorderTopic totals() const;

 private:
    const std::string topic_;
    std::unique_ptr<RawWriter> writer_;
    std::atomic<std::uint64_t> messages_{0};
    std::atomic<std::uint64_t> bytes_{0};
    std::atomic<std::uint64_t> lost_{0};
    std::size_t unacknowledged_ = 0;
};

}  // namespace pursuit::recorder
