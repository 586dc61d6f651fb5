// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "services/recorder/record/drop_cause.hpp"
#include "services/recorder/record/file_sequence.hpp"
#include "services/recorder/record/sample_queue.hpp"

namespace pursuit::recorder {

/// What a recording has done so far; running totals.
struct RecordingFigures {
    FileTotals files;
    std::array<std::uint64_t, drop_causes.size()> dropped{};  ///< In the order of drop_causes.
    std::vector<std::uint64_t> topics_lost;                   ///< All causes, by topic.
    std::size_t queue_bytes = 0;
};

/// Records samples from any thread into files, on a thread of its own.
///
///   push() ─► SampleQueue ─► the writing thread ─► FileSequence
///
/// The disk may stall for as long as the queue lasts; nobody who pushes ever waits for it.
class Recording {
 public:
    using OnError = FileSequence::OnError;
    using NewFileDone = std::function<void(const Result<std::string>& path)>;

    /// Opens the first file, or begins in fault (FileSequence), and starts the thread. `on_error`
    /// is called on that thread, and here before it starts.
    static Result<std::unique_ptr<Recording>> start(FileOptions options, std::size_t queue_bytes,
                                                    std::vector<TopicFacts> topics,
                                                    RecordingFile::Discovered discovered,
                                                    OnError on_error);
    ~Recording();
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;

    /// Any thread; never blocks. What cannot be taken is counted.
    void push(Sample&& sample);
    /// `messages` of a topic were sent and never came.
    void lost_in_transport(std::size_t topic, std::uint64_t messages) {
        count(topic, DropCause::transport, messages);
    }

    void pause(bool paused) { paused_.store(paused); }
    bool paused() const { return paused_.load(); }

    /// The writing thread closes the file, begins a new one and calls `done`.
    void new_file(NewFileDone done);

    /// Writes what waits, for at most `at_most`, and closes the file.
    void stop(std::chrono::milliseconds at_most);
    /// Begins that and does not wait for its end; stop() must follow.
    void ask_to_stop(std::chrono::milliseconds at_most);

    RecordingFigures figures() const;
    const std::vector<TopicFacts>& topics() const { return topics_; }

 private:
    Recording(FileOptions options, std::size_t queue_bytes, std::vector<TopicFacts> topics,
              RecordingFile::Discovered discovered, OnError on_error);

    void run();
    void serve_new_file();
    void publish_totals();
    void count(std::size_t topic, DropCause cause, std::uint64_t messages) {
        dropped_[static_cast<std::size_t>(cause)].fetch_add(messages);
        topics_lost_[topic].fetch_add(messages);
    }

    const std::vector<TopicFacts> topics_;
    const std::chrono::milliseconds period_;
    SampleQueue queue_;
    FileSequence files_;  ///< Of the writing thread, once it runs.
    std::atomic<bool> paused_{false};
    std::array<std::atomic<std::uint64_t>, drop_causes.size()> dropped_{};
    std::vector<std::atomic<std::uint64_t>> topics_lost_;

    mutable std::mutex mutex_;
    FileTotals published_;
    std::vector<NewFileDone> new_file_;
    std::atomic<bool> stopping_{false};
    std::atomic<std::int64_t> stop_at_us_{0};
    std::thread thread_;
};

}  // namespace pursuit::recorder
