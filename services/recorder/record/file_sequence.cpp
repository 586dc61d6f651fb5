// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/file_sequence.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "services/recorder/packet_fields.hpp"
#include "services/recorder/record/output_path.hpp"

namespace pursuit::recorder {
namespace {

void add(const TopicTotals& some, TopicTotals& sum) {
    sum.messages += some.messages;
    sum.bytes += some.bytes;
}

}  // namespace

FileSequence::FileSequence(FileOptions options, const std::vector<TopicFacts>& topics,
                           RecordingFile::Discovered discovered, OnError on_error)
    : options_(std::move(options)),
      topics_(topics),
      discovered_(std::move(discovered)),
      on_error_(std::move(on_error)),
      latched_(topics),
      in_chunk_(topics.size()),
      unflushed_(topics.size()) {
    totals_.topics.resize(topics.size());
    totals_.topics_lost.resize(topics.size());
}

Result<void> FileSequence::begin(const Now& now) {
    if (auto ok = check_output(expand_time(options_.output, now.host_ns)); !ok) return ok;
    if (const auto ok = open(now); !ok) give_up(ok.error().message, now);
    return {};
}

Result<void> FileSequence::open(const Now& now) {
    path_ = free_path(expand_time(options_.output, now.host_ns));
    auto made = begin_file(path_, now);
    if (!made) return tl::unexpected(made.error());
    file_.emplace(std::move(*made));
    begun_bytes_ = file_->bytes();
    begun_chunks_ = file_->totals().chunks;
    accounted_ = {};
    totals_.file = path_;
    totals_.fault.clear();
    ++totals_.changes;
    account(now);
    return {};
}

Result<RecordingFile> FileSequence::begin_file(const std::string& path, const Now& now) {
    auto output = options_.create(path);
    // What may be there by that name is another's, as of a recorder that was faster.
    if (!output) return tl::unexpected(output.error());
    auto made = RecordingFile::create(std::move(*output), path, options_.writer, now.steady_us,
                                      topics_, discovered_);
    if (made) {
        if (const auto ok = write_latched(*made); !ok) made = tl::unexpected(ok.error());
    }
    std::error_code ignored;  // the error at hand is the one that matters
    if (!made) std::filesystem::remove(path, ignored);
    return made;
}

Result<void> FileSequence::write_latched(RecordingFile& file) {
    latched_.forget([this](const Sample& sample) {
        return discovered_(topics_[sample.topic], sample.id.writer).gone;
    });
    if (latched_.samples().empty()) return {};
    for (const auto& [key, latched] : latched_.samples()) {
        Sample sample = latched;
        // They are recorded now: a file is no longer than what happened while it was written.
        sample.reception_time_ns = last_reception_ns_;
        // One that is refused was told of when it came; the file's own failure is told by flush().
        static_cast<void>(file.write(sample));
    }
    return file.flush();
}

void FileSequence::keep_latched(const Sample& sample) {
    last_reception_ns_ = std::max(last_reception_ns_, sample.reception_time_ns);
    if (latched_.take(sample) || told_latched_full_) return;
    told_latched_full_ = true;
    on_error_(topics_[sample.topic].name +
              ": too much is latched to keep it; later files do not begin with all of it");
}

bool FileSequence::large() const {
    if (options_.max_file_bytes == 0) return false;
    return file_->bytes() >= std::max(options_.max_file_bytes, 2 * begun_bytes_);
}

void FileSequence::write(const Sample& sample, const Now& now) {
    count_gap(sample);
    keep_latched(sample);
    auto& in_chunk = in_chunk_[sample.topic];
    if (!file_) {
        lose(sample.topic, 1, totals_.lost_disk);
        return;
    }
    ++in_chunk.messages;
    in_chunk.bytes += sample.payload.size();
    if (const auto ok = file_->write(sample); !ok) {
        // The file's own failure is told again by every later call; otherwise it is this sample's.
        if (const auto file_ok = file_->tick(now.steady_us); !file_ok) {
            give_up(file_ok.error().message, now);
            return;
        }
        --in_chunk.messages;
        in_chunk.bytes -= sample.payload.size();
        lose(sample.topic, 1, totals_.lost_refused);
        on_error_(file_->path() + ": " + ok.error().message);
    }
    account(now);
    if (large() || file_->full()) {
        if (const auto ok = new_file(now); !ok) give_up(ok.error().message, now);
    }
}

void FileSequence::tick(const Now& now) {
    if (file_) {
        if (const auto ok = file_->tick(now.steady_us); !ok) {
            give_up(ok.error().message, now);
        } else {
            account(now);
        }
        return;
    }
    if (now.steady_us < retry_at_us_) return;
    if (const auto ok = open(now); !ok) give_up(ok.error().message, now);
}

Result<std::string> FileSequence::new_file(const Now& now) {
    close(now);
    if (auto ok = open(now); !ok) {
        give_up(ok.error().message, now);
        return tl::unexpected(ok.error());
    }
    return totals_.file;
}

void FileSequence::close(const Now& now) {
    if (!file_) return;
    if (const auto ok = file_->close(); !ok) {
        give_up(ok.error().message, now);
        return;
    }
    account(now);
    file_.reset();
}

void FileSequence::give_up(const std::string& error, const Now& now) {
    if (file_) {
        account(now);
        for (std::size_t i = 0; i < in_chunk_.size(); ++i) {
            lose(i, unflushed_[i].messages + in_chunk_[i].messages, totals_.lost_disk);
            unflushed_[i] = {};
            in_chunk_[i] = {};
        }
        const bool empty = file_->totals().chunks == begun_chunks_;
        const auto path = file_->path();
        file_.reset();
        std::error_code ignored;  // it stays then, and is in nobody's way
        if (empty) std::filesystem::remove(path, ignored);
    }
    retry_at_us_ = now.steady_us + retry_us;
    // With %t the name is another at each try, but the reason is still the same.
    auto reason = error.starts_with(path_) ? error.substr(path_.size()) : error;
    const bool told = !totals_.fault.empty() && reason == reason_;
    reason_ = std::move(reason);
    if (told) return;
    totals_.fault = error;
    ++totals_.changes;
    on_error_(error);
}

void FileSequence::account(const Now& now) {
    const auto& file = file_->totals();
    totals_.bytes_written += file.bytes - accounted_.bytes;
    if (file.flushed_bytes != accounted_.flushed_bytes) totals_.last_flush_host_ns = now.host_ns;
    totals_.chunks_written += file.chunks - accounted_.chunks;
    const bool closed = file.chunks != accounted_.chunks;
    const bool flushed = file.flushed_bytes == file.bytes;  // every chunk that is closed
    for (std::size_t i = 0; i < in_chunk_.size(); ++i) {
        if (closed) add(std::exchange(in_chunk_[i], {}), unflushed_[i]);
        if (!flushed) continue;
        totals_.messages += unflushed_[i].messages;
        add(std::exchange(unflushed_[i], {}), totals_.topics[i]);
    }
    accounted_.bytes = file.bytes;
    accounted_.flushed_bytes = file.flushed_bytes;
    accounted_.chunks = file.chunks;
}

void FileSequence::lose(std::size_t topic, std::uint64_t messages, std::uint64_t& cause) {
    cause += messages;
    totals_.topics_lost[topic] += messages;
}

void FileSequence::count_gap(const Sample& sample) {
    if (sample.kind != SampleKind::data ||
        topics_[sample.topic].type_name != "pursuit::v1::EventPacket") {
        return;
    }
    if (const auto packet = PacketFields::of(sample.payload)) {
        gaps_.take(sample.topic, packet->stream_id(), packet->sequence_number());
        totals_.gaps = gaps_.gaps();
    }
}

}  // namespace pursuit::recorder
