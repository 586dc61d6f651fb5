// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/replay_activity.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "services/recorder/mcap/facts.hpp"

namespace pursuit::recorder {
namespace {

/// The writer keeps 64 packets: with half of them unacknowledged none is overwritten unsent.
constexpr std::size_t most_unacknowledged = 32;

/// A replay that is this late catches up, and then waits for acknowledgements.
constexpr std::int64_t hurried_ns = 5'000'000;

/// A reader that has not acknowledged for so long is stuck; the others wait no longer for it.
constexpr auto acknowledged_within = std::chrono::milliseconds(2000);

/// A writer that knows of a reader may be ahead of the reader's knowing of the writer, and what is
/// sent in between is lost (9 ms of it were seen on a busy host).
constexpr std::int64_t settling_ns = 250'000'000;

/// A packet is sent at most so long after its events; more is a clock that was set.
constexpr std::int64_t most_host_lag_ns = 1'000'000'000;

bool carries_packets(const std::string& topic) {
    return topic == topic::events || topic == topic::exposures;
}

Guid guid_of(const mcap::Channel& channel) {
    Guid guid{};
    const auto text = channel.metadata.find("pursuit.writer_guid");
    if (text == channel.metadata.end() || text->second.size() != 32) return guid;
    for (std::size_t i = 0; i < guid.size(); ++i) {
        const auto digits = text->second.substr(2 * i, 2);
        guid[i] = static_cast<std::uint8_t>(std::strtoul(digits.c_str(), nullptr, 16));
    }
    return guid;
}

}  // namespace

ReplayActivity::ReplayActivity(const disk::RecorderConfig& configuration, Health& health)
    : configuration_(configuration), health_(health), pace_(clock_, configuration.rate()) {}

ReplayActivity::~ReplayActivity() { stop(); }

std::string ReplayActivity::refusal_of(const std::string& topic) {
    if (topic == topic::tracker_request || carries_packets(topic)) return "";
    if (topic.ends_with("/request") || topic.ends_with("/reply")) {
        return "a replay does not send " + topic;
    }
    return "";
}

Result<void> ReplayActivity::start() {
    // A file that is not there or no recording is told at once.
    auto input = mcap::FileInput::open(configuration_.replay());
    if (!input) return tl::unexpected(input.error());
    auto reader = mcap::Reader::open(std::move(*input), configuration_.replay());
    if (!reader) return tl::unexpected(reader.error());
    thread_ = std::thread([this] { run(); });
    return {};
}

void ReplayActivity::stop() {
    pace_.stop();
    if (calls_ && prepared_.load()) calls_->cancel();
    if (thread_.joinable()) thread_.join();
    for (auto& [name, channel] : channels_) channel.writer.reset();
    calls_.reset();
    participant_.reset();
}

bool ReplayActivity::finished() const { return finished_.load() && configuration_.exit_at_end(); }

void ReplayActivity::say(v1::ServiceState state, const std::string& line) {
    const std::scoped_lock lock(mutex_);
    if (state_ == state && line_ == line) return;
    state_ = state;
    line_ = line;
    changes_.fetch_add(1);
}

void ReplayActivity::error(const std::string& message) {
    health_.error(message);
    failed_.store(true);
}

void ReplayActivity::run() {
    if (const auto ok = prepare(); !ok) {
        error(ok.error().message);
    } else if (wait_for_peers()) {
        do {
            if (const auto played = play_once(); !played) {
                error(played.error().message);
                break;
            }
        } while (configuration_.loop() && !pace_.stopped());
    }
    if (failed_.load()) {
        say(v1::SERVICE_FAULT, "the replay of " + configuration_.replay() + " ended with errors");
    } else {
        say(v1::SERVICE_FINISHED, "has replayed " + configuration_.replay());
    }
    finished_.store(true);
}

Result<void> ReplayActivity::prepare() {
    auto plan = make_plan(configuration_.replay(), [this] { return pace_.stopped(); });
    if (!plan) return tl::unexpected(plan.error());
    plan_ = std::move(*plan);
    if (!plan_.damage.empty()) error(plan_.damage);
    if (plan_.malformed > 0) {
        error(configuration_.replay() + ": " + std::to_string(plan_.malformed) +
              " messages are not of their topic's type and are left out");
    }
    if (plan_.gaps > 0) {
        spdlog::warn("{}: the recording has {} gaps, {} packets are missing",
                     configuration_.replay(), plan_.gaps, plan_.packets_missed);
    }
    if (plan_.unanswered > 0) {
        spdlog::warn("{}: {} requests have no reply in the recording and are left out",
                     configuration_.replay(), plan_.unanswered);
    }
    const auto& wanted = configuration_.topic();
    const auto is_wanted = [&](const std::string& name) {
        if (!wanted.empty()) return std::find(wanted.begin(), wanted.end(), name) != wanted.end();
        return carries_packets(name) || name == topic::tracker_request;
    };
    if (!is_wanted(topic::tracker_request)) plan_.calls.clear();

    std::string partition = configuration_.name();
    if (partition.empty() && plan_.partitions.size() == 1) partition = plan_.partitions.front();
    auto participant =
        Participant::create(configuration_.dds(), "pursuit-recorder/replay", partition);
    if (!participant) return tl::unexpected(participant.error());
    participant_ = std::move(*participant);
    for (const auto& [name, messages] : plan_.messages) {
        const auto* topic = find_raw_topic(name);
        if (topic == nullptr || name == topic::tracker_request || !is_wanted(name)) continue;
        auto writer = RawWriter::create(*participant_, *topic);
        if (!writer) return tl::unexpected(writer.error());
        auto& channel = channels_[name];
        channel.writer = std::move(*writer);
        channel.packets = carries_packets(name);
    }
    if (is_wanted(topic::tracker_request)) {
        auto calls = TrackerCalls::create(*participant_, plan_);
        if (!calls) return tl::unexpected(calls.error());
        calls_ = std::move(*calls);
    }
    prepared_.store(true);
    if (channels_.empty() && plan_.call_count() == 0) {
        return fail(configuration_.replay() + ": holds none of the topics to replay");
    }
    return {};
}

bool ReplayActivity::wait_for_peers() {
    // Those of the events, or of what there is in place of them.
    const auto events = channels_.find(topic::events);
    const auto leading = events == channels_.end() ? channels_.begin() : events;
    const auto wanted = static_cast<int>(configuration_.wait_for_subscribers());
    std::optional<std::int64_t> there_since_ns;
    while (!pace_.stopped()) {
        const bool heard =
            leading == channels_.end() || leading->second.writer->matched() >= wanted;
        const bool served = plan_.call_count() == 0 || wanted == 0 ||
                            calls_->wait_matched(std::chrono::milliseconds(0));
        if (heard && served) {
            const auto now_ns = clock_.steady_ns();
            if (!there_since_ns) there_since_ns = now_ns;
            if (wanted == 0 || now_ns - *there_since_ns >= settling_ns) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            continue;
        }
        there_since_ns.reset();
        say(v1::SERVICE_WAITING,
            heard ? std::string("waits for a tracker on ") + topic::tracker_request
                  : "waits for " + std::to_string(wanted) + " readers of " + leading->first +
                        ", there are " + std::to_string(leading->second.writer->matched()));
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

Result<void> ReplayActivity::play_once() {
    auto input = mcap::FileInput::open(configuration_.replay());
    if (!input) return tl::unexpected(input.error());
    auto reader = mcap::Reader::open(std::move(*input), configuration_.replay(), {},
                                     mcap::OnDamage::skip_chunk);
    if (!reader) return tl::unexpected(reader.error());
    calls_left_ = plan_.calls;
    streams_.clear();
    new_stream_ids_.clear();
    next_stream_id_ = static_cast<std::uint64_t>(clock_.realtime_ns());
    tracker_room_ = 0;
    pace_.restart();
    say(v1::SERVICE_RUNNING, "replays " + configuration_.replay());
    while (!pace_.stopped()) {
        const auto message = reader->next();
        if (!message || !*message) break;  // damage was told by the first pass
        const auto& view = **message;
        const auto channel = channels_.find(view.channel->topic);
        if (channel == channels_.end() ||
            view.channel->message_encoding != mcap::message_encoding) {
            continue;
        }
        if (auto ok = play(view, channel->second); !ok) return ok;
    }
    if (pace_.stopped()) return {};
    make_calls_left();
    for (auto& [name, channel] : channels_) wait_acknowledged(channel);
    return {};
}

Result<void> ReplayActivity::play(const mcap::MessageView& message, Channel& channel) {
    std::optional<PacketFields> packet;
    if (channel.packets) {
        packet = PacketFields::of(message.data);
        if (!packet) return {};  // counted by the first pass
    }
    const auto due = pace_.wait(message.head.log_time_ns);
    if (!due) return {};
    Payload payload(message.data.begin(), message.data.end());
    if (packet) {
        if (message.channel->topic == topic::events) make_calls(*packet);
        renew(payload, *packet, message.head.log_time_ns, *due);
    }
    keep_room(channel, due->rate == 0 || due->late_ns > hurried_ns);
    if (pace_.stopped()) return {};
    const SampleId original{guid_of(*message.channel), message.head.sequence};
    const auto size = payload.size();
    if (!channel.writer->write(payload, message.head.publish_time_ns, original)) {
        channel.lost.fetch_add(1);
        error("a message on " + message.channel->topic + " could not be sent");
        return {};
    }
    ++channel.unacknowledged;
    channel.messages.fetch_add(1);
    channel.bytes.fetch_add(size);
    return {};
}

void ReplayActivity::renew(Payload& payload, const PacketFields& packet, std::int64_t log_time_ns,
                           const ReplayPace::Due& due) {
    const auto [place, first] = new_stream_ids_.try_emplace(packet.stream_id(), next_stream_id_);
    if (first) ++next_stream_id_;
    packet.set_stream_id(payload, place->second);
    const auto lag_ns =
        std::clamp<std::int64_t>(log_time_ns - packet.host_time_ns(), 0, most_host_lag_ns);
    const auto host_ns =
        due.rate > 0
            ? due.realtime_ns - static_cast<std::int64_t>(static_cast<double>(lag_ns) / due.rate)
            : due.realtime_ns;
    packet.set_host_time_ns(payload, host_ns);
    packet.set_recorded_host_time_ns(payload, packet.host_time_ns());
}

void ReplayActivity::make_calls(const PacketFields& packet) {
    auto& streams = streams_[packet.sensor_id()];
    const bool begins_stream =
        std::find(streams.begin(), streams.end(), packet.stream_id()) == streams.end();
    if (begins_stream) streams.push_back(packet.stream_id());
    const auto found = calls_left_.find(packet.sensor_id());
    if (found == calls_left_.end()) return;
    const std::size_t stream = streams.size() - 1;
    for (auto& calls = found->second; !calls.empty(); calls.pop_front()) {
        const auto& call = calls.front();
        const auto apply_at_us = call.request.apply_at_us();
        const bool due =
            call.stream < stream || (call.stream == stream && apply_at_us <= packet.reached_us());
        if (!due || pace_.stopped()) return;
        const bool before_all = call.stream < stream || apply_at_us <= packet.first_us();
        make_call(call, begins_stream && before_all);
    }
}

void ReplayActivity::make_calls_left() {
    for (auto& [sensor_id, calls] : calls_left_) {
        for (const auto& call : calls) make_call(call, false);
    }
    calls_left_.clear();
}

void ReplayActivity::make_call(const PlannedCall& call, bool begins_stream) {
    if (pace_.stopped()) return;
    if (begins_stream) {
        // The stream before must be there to its end: topics keep no order between them.
        for (auto& [name, channel] : channels_) wait_acknowledged(channel);
    }
    const auto made = calls_->make(call, begins_stream);
    if (made) {
        calls_made_.fetch_add(1);
    } else if (!pace_.stopped()) {
        calls_failed_.fetch_add(1);
        error(made.error().message);
    }
}

// Acknowledged is what a reader has; what its tracker has dealt with only the tracker knows. As
// fast as possible must not mean faster than that: its queue drops what it cannot hold.
void ReplayActivity::keep_room(Channel& channel, bool hurried) {
    if (!hurried) {
        channel.unacknowledged = 0;
        return;
    }
    if (channel.unacknowledged >= most_unacknowledged) wait_acknowledged(channel);
    if (!calls_ || !channel.packets) return;
    while (tracker_room_ == 0 && !pace_.stopped()) {
        const auto room = calls_->room();
        if (!room) {
            if (!pace_.stopped()) error(room.error().message);
            tracker_room_ = most_unacknowledged;  // go on: others may listen
            return;
        }
        tracker_room_ = *room;
        if (tracker_room_ == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (tracker_room_ > 0) --tracker_room_;
}

void ReplayActivity::wait_acknowledged(Channel& channel) {
    constexpr auto step = std::chrono::milliseconds(100);
    for (auto waited = step - step; waited < acknowledged_within; waited += step) {
        if (pace_.stopped() || channel.writer->wait_acknowledged(step)) {
            channel.unacknowledged = 0;
            return;
        }
    }
    channel.unacknowledged = 0;
    if (unacknowledged_.fetch_add(1) == 0) {
        error("a reader has not acknowledged for " + std::to_string(acknowledged_within.count()) +
              " ms; the replay goes on without it");
    }
}

std::string ReplayActivity::status_line() const {
    const std::scoped_lock lock(mutex_);
    return (pace_.paused() && state_ == v1::SERVICE_RUNNING ? "paused: " : "") + line_;
}

v1::ServiceState ReplayActivity::state() const {
    const std::scoped_lock lock(mutex_);
    return pace_.paused() && state_ == v1::SERVICE_RUNNING ? v1::SERVICE_PAUSED : state_;
}

void ReplayActivity::fill(v1::RecorderStatus& status) const {
    status.replaying(true);
    status.file(bounded(configuration_.replay(), 255));
    status.rate(pace_.rate());
    if (!prepared_.load()) return;
    status.gaps(plan_.gaps);
    std::uint64_t lost = 0;
    for (const auto& [name, channel] : channels_) {
        v1::RecorderTopic topic;
        topic.topic(name);
        topic.messages(channel.messages.load());
        topic.bytes(channel.bytes.load());
        topic.lost(channel.lost.load());
        status.messages(status.messages() + channel.messages.load());
        lost += channel.lost.load();
        status.topics().push_back(topic);
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
    drop("malformed", plan_.malformed);
    drop("call_failed", calls_failed_.load());
    drop("unanswered", plan_.unanswered);
}

Result<void> ReplayActivity::pause(bool paused) {
    pace_.pause(paused);
    changes_.fetch_add(1);
    return {};
}

Result<void> ReplayActivity::set_rate(double rate) {
    pace_.set_rate(rate);
    changes_.fetch_add(1);
    return {};
}

void ReplayActivity::new_file(Done done) {
    done(v1::STATUS_UNSUPPORTED, "new_file: a replay writes no file");
}

}  // namespace pursuit::recorder
