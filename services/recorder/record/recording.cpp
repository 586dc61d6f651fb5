// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/recording.hpp"

#include <algorithm>

namespace pursuit::recorder {
namespace {

/// Between two looks at the clock for old chunks; few, so that the queue's figures stay true.
constexpr std::size_t samples_a_turn = 64;

Now now() {
    using namespace std::chrono;
    return {duration_cast<microseconds>(steady_clock::now().time_since_epoch()).count(),
            duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count()};
}

}  // namespace

Recording::Recording(FileOptions options, std::size_t queue_bytes, std::vector<TopicFacts> topics,
                     RecordingFile::Discovered discovered, OnError on_error)
    : topics_(std::move(topics)),
      // A chunk is closed at most a quarter of its age late.
      period_(std::clamp<std::int64_t>(options.writer.chunk_age_us / 4000, 1, 50)),
      queue_(queue_bytes),
      files_(std::move(options), topics_, std::move(discovered), std::move(on_error)),
      topics_lost_(topics_.size()) {}

Result<std::unique_ptr<Recording>> Recording::start(FileOptions options, std::size_t queue_bytes,
                                                    std::vector<TopicFacts> topics,
                                                    RecordingFile::Discovered discovered,
                                                    OnError on_error) {
    std::unique_ptr<Recording> self(new Recording(std::move(options), queue_bytes,
                                                  std::move(topics), std::move(discovered),
                                                  std::move(on_error)));
    if (auto ok = self->files_.begin(now()); !ok) return tl::unexpected(ok.error());
    self->publish_totals();
    self->thread_ = std::thread([recording = self.get()] { recording->run(); });
    return self;
}

Recording::~Recording() { stop(std::chrono::milliseconds(0)); }

void Recording::push(Sample&& sample) {
    const auto topic = sample.topic;
    if (paused_.load(std::memory_order_relaxed)) {
        count(topic, DropCause::paused, 1);
    } else if (!queue_.push(std::move(sample))) {
        count(topic, DropCause::queue_full, 1);
    }
}

void Recording::new_file(NewFileDone done) {
    {
        const std::scoped_lock lock(mutex_);
        new_file_.push_back(std::move(done));
    }
    queue_.wake();
}

void Recording::stop(std::chrono::milliseconds at_most) {
    if (!thread_.joinable()) return;
    ask_to_stop(at_most);
    thread_.join();
}

void Recording::ask_to_stop(std::chrono::milliseconds at_most) {
    stop_at_us_.store(now().steady_us + at_most.count() * 1000);
    stopping_.store(true);
    queue_.wake();
}

RecordingFigures Recording::figures() const {
    RecordingFigures figures;
    {
        const std::scoped_lock lock(mutex_);
        figures.files = published_;
    }
    figures.queue_bytes = queue_.bytes();
    figures.topics_lost = figures.files.topics_lost;
    for (std::size_t i = 0; i < topics_lost_.size(); ++i) {
        figures.topics_lost[i] += topics_lost_[i].load();
    }
    for (std::size_t i = 0; i < dropped_.size(); ++i) figures.dropped[i] = dropped_[i].load();
    figures.dropped[static_cast<std::size_t>(DropCause::disk)] += figures.files.lost_disk;
    figures.dropped[static_cast<std::size_t>(DropCause::refused)] += figures.files.lost_refused;
    return figures;
}

void Recording::run() {
    while (true) {
        // Asked before the queue is looked at, so that what came before a stop is written.
        const bool last = stopping_.load();
        const auto samples =
            queue_.take(last ? std::chrono::milliseconds(0) : period_, samples_a_turn);
        if (last && samples.empty()) break;
        for (const auto& sample : samples) {
            if (last && now().steady_us >= stop_at_us_.load()) {
                count(sample.topic, DropCause::stopping, 1);
                continue;
            }
            files_.write(sample, now());
        }
        files_.tick(now());
        serve_new_file();
        publish_totals();
    }
    files_.close(now());
    serve_new_file();
    publish_totals();
}

void Recording::serve_new_file() {
    std::vector<NewFileDone> waiting;
    {
        const std::scoped_lock lock(mutex_);
        waiting.swap(new_file_);
    }
    if (waiting.empty()) return;
    // Several that came together ask for one new file.
    const auto path = stopping_.load() ? Result<std::string>(fail("the recorder is stopping"))
                                       : files_.new_file(now());
    publish_totals();
    for (const auto& done : waiting) done(path);
}

void Recording::publish_totals() {
    const std::scoped_lock lock(mutex_);
    published_ = files_.totals();
}

}  // namespace pursuit::recorder
