// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/replay_outlet.hpp"

#include "services/recorder/replay/replay_topics.hpp"

namespace pursuit::recorder {

Result<std::unique_ptr<ReplayOutlet>> ReplayOutlet::create(
    const disk::RecorderConfig& configuration, const ReplayPlan& plan, const ReplayPace& pace,
    OnError on_error) {
    std::unique_ptr<ReplayOutlet> self(new ReplayOutlet(pace, std::move(on_error)));
    std::string partition = configuration.name();
    if (partition.empty() && plan.partitions.size() == 1) partition = plan.partitions.front();
    auto participant =
        Participant::create(configuration.dds(), "pursuit-recorder/replay", partition);
    if (!participant) return tl::unexpected(participant.error());
    self->participant_ = std::move(*participant);
    const std::vector<std::string> wanted(configuration.topic().begin(),
                                          configuration.topic().end());
    for (const auto& [name, messages] : plan.messages) {
        const auto* topic = find_raw_topic(name);
        if (topic == nullptr || name == topic::tracker_request || !is_replayed(name, wanted)) {
            continue;
        }
        auto writer = RawWriter::create(*self->participant_, *topic);
        if (!writer) return tl::unexpected(writer.error());
        self->channels_.try_emplace(name, name, std::move(*writer));
    }
    if (is_replayed(topic::tracker_request, wanted)) {
        auto calls = TrackerCalls::create(*self->participant_, plan);
        if (!calls) return tl::unexpected(calls.error());
        self->calls_ = std::move(*calls);
    }
    self->makes_calls_ = plan.call_count() > 0;
    return self;
}

std::string ReplayOutlet::missing(int readers) {
    const auto events = channels_.find(topic::events);
    const auto leading = events == channels_.end() ? channels_.begin() : events;
    if (leading != channels_.end() && leading->second.matched() < readers) {
        return std::to_string(readers) + " readers of " + leading->first + ", there are " +
               std::to_string(leading->second.matched());
    }
    if (makes_calls_ && readers != 0 && !calls_->wait_matched(std::chrono::milliseconds(0))) {
        return std::string("a tracker on ") + topic::tracker_request;
    }
    return "";
}

ReplayChannel* ReplayOutlet::channel(const std::string& topic) {
    const auto found = channels_.find(topic);
    return found == channels_.end() ? nullptr : &found->second;
}

void ReplayOutlet::send(ReplayChannel& channel, Payload& payload, std::int64_t source_time_ns,
                        const SampleId& original, bool hurried) {
    flow_.hold_back(channel, hurried, carries_packets(channel.topic()) ? calls_.get() : nullptr);
    if (pace_.stopped()) return;
    if (!channel.write(payload, source_time_ns, original)) {
        on_error_("a message on " + channel.topic() + " could not be sent");
    }
}

void ReplayOutlet::make(const PlannedCall& call, bool begins_stream) {
    if (pace_.stopped()) return;
    // The stream before must be there to its end: topics keep no order between them.
    if (begins_stream) settle();
    const auto made = calls_->make(call, begins_stream);
    if (made) {
        calls_made_.fetch_add(1);
    } else if (!pace_.stopped()) {
        calls_failed_.fetch_add(1);
        on_error_(made.error().message);
    }
}

void ReplayOutlet::settle() {
    for (auto& [name, channel] : channels_) flow_.wait_acknowledged(channel);
}

void ReplayOutlet::cancel() {
    if (calls_) calls_->cancel();
}

void ReplayOutlet::close() {
    for (auto& [name, channel] : channels_) channel.close();
    calls_.reset();
    participant_.reset();
}

void ReplayOutlet::fill(v1::RecorderStatus& status, const ReplayPlan& plan) const {
    std::uint64_t lost = 0;
    for (const auto& [name, channel] : channels_) {
        const auto totals = channel.totals();
        status.messages(status.messages() + totals.messages());
        lost += totals.lost();
        status.topics().push_back(totals);
    }
    if (calls_) {
        v1::RecorderTopic topic;
        topic.topic(topic::tracker_request);
        topic.messages(calls_made_.load());
        topic.lost(calls_failed_.load());
        status.topics().push_back(topic);
    }
    const auto drop = [&](const char* name, std::uint64_t count) {
        v1::NamedCount cause;
        cause.name(name);
        cause.count(count);
        status.dropped_by().push_back(cause);
        status.messages_dropped(status.messages_dropped() + count);
    };
    drop("not_sent", lost);
    drop("malformed", plan.malformed);
    drop("call_failed", calls_failed_.load());
    drop("unanswered", plan.unanswered);
    drop("unasked", plan.unasked);
    if (participant_) count_peers(participant_->counts(), status.dropped_by());
}

}  // namespace pursuit::recorder
