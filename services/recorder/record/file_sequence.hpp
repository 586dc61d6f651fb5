// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/recorder/record/latched_samples.hpp"
#include "services/recorder/record/recording_file.hpp"
#include "services/recorder/stream_gaps.hpp"

namespace pursuit::recorder {

/// Both clocks at one instant.
struct Now {
    std::int64_t steady_us = 0;
    std::int64_t host_ns = 0;  ///< CLOCK_REALTIME.
};

struct FileOptions {
    std::string output;  ///< Path; %t becomes the UTC time at which a file is begun.
    mcap::WriterOptions writer;
    /// A next file is begun at this size, but not before a file holds as much of its own as what it
    /// begins with. 0: no bound.
    std::uint64_t max_file_bytes = 0;

    using Create = std::function<Result<std::unique_ptr<mcap::Output>>(const std::string& path)>;
    Create create = mcap::FileOutput::create;
};

struct TopicTotals {
    std::uint64_t messages = 0;
    std::uint64_t bytes = 0;  ///< Of payloads.
};

/// Running totals since the start, over all files.
struct FileTotals {
    std::string file;           ///< The one being written, or the last one.
    std::string fault;          ///< Why there is none being written; empty when there is.
    std::uint64_t changes = 0;  ///< Of file and fault.
    std::uint64_t bytes_written = 0;
    std::uint64_t chunks_written = 0;
    std::int64_t last_flush_host_ns = 0;
    std::uint64_t messages = 0;   ///< In chunks that are flushed.
    std::uint64_t lost_disk = 0;  ///< Could not be written.
    std::uint64_t lost_refused = 0;
    std::uint64_t gaps = 0;  ///< Breaks of event streams.
    std::vector<TopicTotals> topics;
    std::vector<std::uint64_t> topics_lost;  ///< Both causes, by topic.
};

/// A recording over one or several files.
///
///   begin() ─► recording ── full, or new_file() ──────────► recording, in the next file
///      │          │ the disk gives an error        every second: a next file is tried
///      │          ▼                                        │
///      └─────►  fault ── samples are dropped and counted ──┘
///
/// Every file but the first begins with what the latched topics held then (LatchedSamples): the
/// models and settings without which its events give no poses. They have the publish time of their
/// own, and as log time that of the last sample before; they are in no total of messages.
///
/// A file that was given up stays, readable up to its last chunk; one that holds nothing of its own
/// is removed. A message counts as recorded when its chunk is flushed to the disk, and as lost when
/// the chunk cannot be written or flushed: what the kernel could not flush it may have dropped. One
/// thread.
class FileSequence {
 public:
    using OnError = std::function<void(const std::string&)>;

    /// `topics` must outlive this.
    FileSequence(FileOptions options, const std::vector<TopicFacts>& topics,
                 RecordingFile::Discovered discovered, OnError on_error);

    /// Opens the first file, or begins in fault. An error only where trying again would not help
    /// (check_output).
    Result<void> begin(const Now& now);
    void write(const Sample& sample, const Now& now);
    /// Closes chunks that are old enough, tries again after a fault. At least every chunk age / 4.
    void tick(const Now& now);
    /// Closes the file and goes on in a new one; its path.
    Result<std::string> new_file(const Now& now);
    /// Closes the file. Nothing may be written after it.
    void close(const Now& now);

    const FileTotals& totals() const { return totals_; }

    static constexpr std::int64_t retry_us = 1'000'000;

 private:
    Result<void> open(const Now& now);
    Result<RecordingFile> begin_file(const std::string& path, const Now& now);
    Result<void> write_latched(RecordingFile& file);
    void keep_latched(const Sample& sample);
    bool large() const;
    void give_up(const std::string& error, const Now& now);
    void account(const Now& now);
    void lose(std::size_t topic, std::uint64_t messages, std::uint64_t& cause);
    void count_gap(const Sample& sample);

    FileOptions options_;
    const std::vector<TopicFacts>& topics_;
    RecordingFile::Discovered discovered_;
    OnError on_error_;
    LatchedSamples latched_;
    bool told_latched_full_ = false;
    std::int64_t last_reception_ns_ = 0;
    std::string path_;  ///< Of the file that was tried last.
    std::optional<RecordingFile> file_;
    std::uint64_t begun_bytes_ = 0;  ///< Of file_, what it began with.
    std::uint64_t begun_chunks_ = 0;
    mcap::WriterTotals accounted_;        ///< Of file_, what is in totals_ already.
    std::vector<TopicTotals> in_chunk_;   ///< The open chunk, by topic.
    std::vector<TopicTotals> unflushed_;  ///< Closed chunks, likewise.
    std::int64_t retry_at_us_ = 0;
    std::string reason_;  ///< Of the last fault, without the path.
    StreamGaps gaps_;
    FileTotals totals_;
};

}  // namespace pursuit::recorder
