// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/recorder/mcap_sample.hpp"

namespace pursuit::recorder {
namespace {

using std::chrono::milliseconds;

/// What the writing thread waits at while it is shut.
class Gate {
 public:
    void set_open(bool open) {
        const std::scoped_lock lock(mutex_);
        open_ = open;
        changed_.notify_all();
    }
    void pass() {
        std::unique_lock lock(mutex_);
        waits_ = true;
        changed_.notify_all();
        changed_.wait(lock, [&] { return open_; });
        waits_ = false;
    }
    void wait_until_one_waits() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return waits_; });
    }

 private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool open_ = true;
    bool waits_ = false;
};

class GatedOutput final : public mcap::Output {
 public:
    GatedOutput(Gate& gate, std::shared_ptr<mcap::MemoryOutput::Disk> disk)
        : gate_(gate), behind_(std::move(disk)) {}
    Result<void> write(mcap::ByteSpan data) override {
        gate_.pass();
        return behind_.write(data);
    }
    Result<void> flush() override { return behind_.flush(); }

 private:
    Gate& gate_;
    mcap::MemoryOutput behind_;
};

/// A recording whose every sample is a chunk, and so a write, of its own.
class DropsOfARecording : public ::testing::Test {
 protected:
    DropsOfARecording() {
        options_.output = folder_.path("a.mcap");
        options_.create = [this](auto&) { return std::make_unique<GatedOutput>(gate_, disk_); };
        options_.writer.chunk_bytes = 1;
        options_.writer.max_message_bytes = 100;
    }
    void start() {
        auto started = Recording::start(
            options_, 2 * SampleQueue::bytes_of(sample(101)), topics_,
            [](auto&, auto&) { return OfferedQos{}; },
            [this](const std::string& error) { errors_.push_back(error); });
        ASSERT_TRUE(started) << started.error().message;
        recording_ = std::move(*started);
    }
    static Sample sample(std::size_t size = 100) {
        Sample sample;
        sample.topic = 1;
        sample.id.writer.fill(1);
        sample.payload.assign(size, 0);
        return sample;
    }
    /// The gate is shut, the writing thread stands at it with one sample, and two more wait.
    void fill_queue() {
        gate_.set_open(false);
        recording_->push(sample());
        gate_.wait_until_one_waits();
        recording_->push(sample());
        recording_->push(sample());
    }
    /// All there are must be `lost` of `cause`, on the topic of the samples.
    void expect_only(DropCause cause, std::uint64_t lost) const {
        const auto figures = recording_->figures();
        for (const auto each : drop_causes) {
            EXPECT_EQ(figures.dropped[static_cast<std::size_t>(each)], each == cause ? lost : 0U)
                << to_string(each);
        }
        EXPECT_THAT(figures.topics_lost, ::testing::ElementsAre(0, lost));
    }
    std::uint64_t written() const { return recording_->figures().files.messages; }

    pursuit::test::TemporaryFolder folder_;  // nothing is written there
    const std::vector<TopicFacts> topics_ = {
        {"pursuit/poses", "pursuit::v1::ObjectPose", true, "poses", 16},
        {"pursuit/tracker/reply", "pursuit::v1::TrackerReply", false, "calls", 128}};
    FileOptions options_;
    Gate gate_;
    const std::shared_ptr<mcap::MemoryOutput::Disk> disk_ =
        std::make_shared<mcap::MemoryOutput::Disk>();
    std::vector<std::string> errors_;
    std::unique_ptr<Recording> recording_;
};

TEST_F(DropsOfARecording, are_none_where_all_is_written_before_the_stop) {
    start();
    fill_queue();
    gate_.set_open(true);
    recording_->stop(milliseconds(60'000));
    expect_only(DropCause::stopping, 0);
    EXPECT_EQ(written(), 3U);
}

TEST_F(DropsOfARecording, are_what_a_full_queue_could_not_take) {
    start();
    fill_queue();
    recording_->push(sample());
    recording_->push(sample());
    expect_only(DropCause::queue_full, 2);
    gate_.set_open(true);
    recording_->stop(milliseconds(60'000));
    expect_only(DropCause::queue_full, 2);
    EXPECT_EQ(written(), 3U);
}

TEST_F(DropsOfARecording, are_what_came_while_it_was_paused) {
    start();
    recording_->pause(true);
    recording_->push(sample());
    recording_->pause(false);
    recording_->push(sample());
    recording_->stop(milliseconds(60'000));
    expect_only(DropCause::paused, 1);
    EXPECT_EQ(written(), 1U);
}

TEST_F(DropsOfARecording, are_what_waited_when_the_time_to_stop_was_over) {
    start();
    fill_queue();
    recording_->ask_to_stop(milliseconds(0));
    gate_.set_open(true);
    recording_->stop(milliseconds(0));
    expect_only(DropCause::stopping, 2);
    EXPECT_EQ(written(), 1U);
}

TEST_F(DropsOfARecording, are_messages_too_large_for_a_file_and_each_is_told) {
    start();
    recording_->push(sample(101));
    recording_->push(sample(100));
    recording_->stop(milliseconds(60'000));
    expect_only(DropCause::refused, 1);
    EXPECT_EQ(written(), 1U);
    EXPECT_THAT(errors_, ::testing::ElementsAre(::testing::HasSubstr("of 101 bytes; at most 100")));
}

TEST_F(DropsOfARecording, are_what_the_disk_did_not_take) {
    disk_->fail_at = 1;  // the beginning is written, the first definition is not
    start();
    recording_->push(sample());
    recording_->stop(milliseconds(60'000));
    expect_only(DropCause::disk, 1);
    EXPECT_EQ(written(), 0U);
}

TEST_F(DropsOfARecording, are_what_was_lost_in_transport) {
    start();
    recording_->lost_in_transport(1, 7);
    expect_only(DropCause::transport, 7);
}

}  // namespace
}  // namespace pursuit::recorder
