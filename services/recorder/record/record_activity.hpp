// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "config.pb.h"
#include "services/common/health.hpp"
#include "services/recorder/activity.hpp"
#include "services/recorder/record/raw_reader.hpp"
#include "services/recorder/record/recording.hpp"
#include "services/recorder/record/writer_registry.hpp"

namespace pursuit::recorder {

/// Records the topics of Pursuit: a raw reader each, and the recording they feed. It has a
/// participant of its own, because within one participant a topic has one type support, and the
/// service reads its requests typed.
class RecordActivity final : public Activity {
 public:
    RecordActivity(const disk::RecorderConfig& configuration, Health& health);
    ~RecordActivity() override;

    Result<void> start() override;
    void tick() override {}
    bool finished() const override { return false; }
    /// The file that was written last could not be.
    bool failed() const override;
    void stop() override;
    std::string status_line() const override;
    v1::ServiceState state() const override;
    std::uint64_t changes() const override;
    void fill(v1::RecorderStatus& status) const override;
    Result<void> pause(bool paused) override;
    Result<void> set_rate(double rate) override;
    void new_file(Done done) override;

 private:
    OfferedQos offered(const TopicFacts& topic, const Guid& writer) const;

    const disk::RecorderConfig& configuration_;
    Health& health_;
    WriterRegistry writers_;
    std::unique_ptr<Recording> recording_;
    std::unique_ptr<Participant> participant_;
    std::vector<std::unique_ptr<RawReader>> readers_;
    std::uint64_t own_changes_ = 0;
};

}  // namespace pursuit::recorder
