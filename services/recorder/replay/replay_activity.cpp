// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/replay_activity.hpp"

#include <spdlog/spdlog.h>

#include "services/recorder/mcap/facts.hpp"
#include "services/recorder/mcap/reader.hpp"
#include "services/recorder/packet_fields.hpp"
#include "services/recorder/replay/replay_topics.hpp"

namespace pursuit::recorder {
namespace {

/// A replay that is this late catches up, and then waits for acknowledgements.
constexpr std::int64_t hurried_ns = 5'000'000;

/// A writer that knows of a reader may be ahead of the reader's knowing of the writer, and what is
/// sent in between is lost (9 ms of it were seen on a busy host).
constexpr std::int64_t settling_ns = 250'000'000;

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

Result<void> ReplayActivity::check(const std::string& path) {
    auto input = mcap::FileInput::open(path);
    if (!input) return tl::unexpected(input.error());
    auto reader = mcap::Reader::open(std::move(*input), path);
    if (!reader) return tl::unexpected(reader.error());
    return {};
}

Result<void> ReplayActivity::start() {
    thread_ = std::thread([this] { run(); });
    return {};
}

void ReplayActivity::stop() {
    pace_.stop();
    if (prepared_.load()) outlet_->cancel();
    if (thread_.joinable()) thread_.join();
    if (outlet_) outlet_->close();
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
    if (pace_.stopped()) return {};  // what was not read is no fault of the file
    plan_ = std::move(*plan);
    tell_plan();
    const auto& wanted = configuration_.topic();
    if (!is_replayed(topic::tracker_request, {wanted.begin(), wanted.end()})) plan_.calls.clear();
    auto outlet = ReplayOutlet::create(configuration_, plan_, pace_,
                                       [this](const std::string& message) { error(message); });
    if (!outlet) return tl::unexpected(outlet.error());
    outlet_ = std::move(*outlet);
    prepared_.store(true);
    if (outlet_->empty()) {
        return fail(configuration_.replay() + ": holds none of the topics to replay");
    }
    return {};
}

void ReplayActivity::tell_plan() {
    if (!plan_.damage.empty()) error(plan_.damage);
    if (plan_.malformed > 0) {
        error(configuration_.replay() + ": " + std::to_string(plan_.malformed) +
              " messages are not of their topic's type and are left out");
    }
    if (plan_.gaps > 0) {
        spdlog::warn("{}: the recording has {} gaps, {} packets are missing",
                     configuration_.replay(), plan_.gaps, plan_.packets_missed);
    }
    if (!plan_.clock_steps.empty()) {
        spdlog::warn(
            "{}: the clock of the host was set {} times while it was recorded; the replay "
            "goes on as if it had not been",
            configuration_.replay(), plan_.clock_steps.size());
    }
    if (plan_.unanswered > 0) {
        spdlog::warn("{}: {} requests have no reply in the recording and are left out",
                     configuration_.replay(), plan_.unanswered);
    }
    if (plan_.unasked > 0) {
        spdlog::warn(
            "{}: of {} calls that the tracker obeyed only the replies are in the recording; the "
            "poses may differ from the recorded ones",
            configuration_.replay(), plan_.unasked);
    }
}

bool ReplayActivity::wait_for_peers() {
    const auto wanted = static_cast<int>(configuration_.wait_for_subscribers());
    std::optional<std::int64_t> there_since_ns;
    while (!pace_.stopped()) {
        const auto missing = outlet_->missing(wanted);
        if (missing.empty()) {
            const auto now_ns = clock_.steady_ns();
            if (!there_since_ns) there_since_ns = now_ns;
            if (wanted == 0 || now_ns - *there_since_ns >= settling_ns) return true;
        } else {
            there_since_ns.reset();
            say(v1::SERVICE_WAITING, "waits for " + missing);
        }
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
    schedule_ = CallSchedule(plan_.calls);
    time_ = SteppedTime(plan_.clock_steps);
    renewal_ = StreamRenewal(static_cast<std::uint64_t>(clock_.realtime_ns()));
    outlet_->restart();
    pace_.restart();
    say(v1::SERVICE_RUNNING, "replays " + configuration_.replay());
    while (!pace_.stopped()) {
        const auto message = reader->next();
        if (!message || !*message) break;  // damage was told by the first pass
        const auto& view = **message;
        const auto time_ns = time_.next(view.head.log_time_ns);
        auto* channel = outlet_->channel(view.channel->topic);
        if (channel == nullptr || view.channel->message_encoding != mcap::message_encoding) {
            continue;
        }
        play(view, time_ns, *channel);
    }
    if (pace_.stopped()) return {};
    make(schedule_.take_rest());
    outlet_->settle();
    return {};
}

void ReplayActivity::play(const mcap::MessageView& message, std::int64_t time_ns,
                          ReplayChannel& channel) {
    std::optional<PacketFields> packet;
    if (carries_packets(channel.topic())) {
        packet = PacketFields::of(message.data);
        if (!packet) return;  // counted by the first pass
    }
    const auto due = pace_.wait(time_ns);
    if (!due) return;
    Payload payload(message.data.begin(), message.data.end());
    if (packet) {
        if (channel.topic() == topic::events) make(schedule_.take(*packet));
        renewal_.renew(payload, *packet, message.head.log_time_ns, *due);
    }
    const SampleId original{guid_of(*message.channel), message.head.sequence};
    outlet_->send(channel, payload, message.head.publish_time_ns, original,
                  due->rate == 0 || due->late_ns > hurried_ns);
}

void ReplayActivity::make(const std::vector<CallSchedule::DueCall>& calls) {
    for (const auto& [call, begins_stream] : calls) outlet_->make(call, begins_stream);
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
    outlet_->fill(status, plan_);
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
