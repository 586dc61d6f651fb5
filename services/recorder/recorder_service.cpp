// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/recorder_service.hpp"

#include <filesystem>

#include "services/common/request_losses.hpp"
#include "services/recorder/record/record_activity.hpp"
#include "services/recorder/replay/replay_activity.hpp"
#include "services/recorder/replay/replay_topics.hpp"
#include "services/recorder/topic_table.hpp"

namespace pursuit::recorder {
namespace {

constexpr auto status_period = std::chrono::seconds(1);

/// The union's member for a call that returns nothing.
v1::RecorderResult result_of(v1::RecorderCallKind kind) {
    v1::RecorderResult result;
    switch (kind) {
        case v1::RECORDER_PAUSE:
            result.pause({});
            break;
        case v1::RECORDER_RESUME:
            result.resume({});
            break;
        case v1::RECORDER_NEW_FILE:
            result.new_file({});
            break;
        case v1::RECORDER_SET_RATE:
            result.set_rate({});
            break;
        case v1::RECORDER_GET_STATUS:
            result.get_status({});
            break;
    }
    return result;
}

}  // namespace

Result<std::unique_ptr<Service>> RecorderService::make(const disk::RecorderConfig& configuration) {
    if (configuration.output().empty() == configuration.replay().empty()) {
        return fail("exactly one of the fields output and replay must be set");
    }
    std::error_code unseen;  // creating the file says what is in the way then
    if (std::filesystem::is_directory(configuration.output(), unseen)) {
        return fail_field("output", ": " + configuration.output() + " is a folder");
    }
    if (!configuration.replay().empty()) {
        const auto found = ReplayActivity::check(configuration.replay());
        if (!found) return fail_field("replay", ": " + found.error().message);
    }
    const double rate = configuration.rate();
    if (rate > 0 && rate < 0.001) {
        return fail_field("rate", " must be 0 (as fast as possible) or 0.001 to 1000");
    }
    for (int i = 0; i < configuration.topic_size(); ++i) {
        const auto& topic = configuration.topic(i);
        const std::string field = "topic[" + std::to_string(i) + "]";
        if (find_raw_topic(topic) != nullptr) {
            const auto refusal = replay_refusal(topic);
            if (configuration.replay().empty() || refusal.empty()) continue;
            return fail_field(field, ": " + refusal);
        }
        std::string names;
        for (const auto& known : raw_topics()) names += std::string(" ") + known.name;
        return fail_field(field, ": there is no topic \"" + topic + "\"; there are" + names);
    }
    return std::make_unique<RecorderService>(configuration);
}

RecorderService::RecorderService(const disk::RecorderConfig& configuration)
    : configuration_(configuration),
      instance_(configuration.name().empty() ? "default" : configuration.name()),
      health_(configuration) {
    if (configuration_.replay().empty()) {
        activity_ = std::make_unique<RecordActivity>(configuration_, health_);
    } else {
        activity_ = std::make_unique<ReplayActivity>(configuration_, health_);
    }
}

RecorderService::~RecorderService() { stop(); }

Result<void> RecorderService::start() {
    auto participant =
        Participant::create(configuration_.dds(), "pursuit-recorder", configuration_.name());
    if (!participant) return tl::unexpected(participant.error());
    participant_ = std::move(*participant);
    if (auto ok = activity_->start(); !ok) return ok;
    auto writer = Writer<v1::RecorderStatus>::create(*participant_, topic::recorder_status);
    if (!writer) return tl::unexpected(writer.error());
    status_writer_ = std::move(*writer);
    auto server = Server::create(*participant_, topic::recorder_request, topic::recorder_reply,
                                 instance_, [this](v1::RecorderRequest& request, Server&) {
                                     const std::scoped_lock lock(mutex_);
                                     requests_.push_back(request);
                                 });
    if (!server) return tl::unexpected(server.error());
    server_ = std::move(*server);
    publish_status();
    return {};
}

void RecorderService::tick() {
    activity_->tick();
    server_->tick();
    std::deque<v1::RecorderRequest> requests;
    {
        const std::scoped_lock lock(mutex_);
        requests.swap(requests_);
    }
    for (const auto& request : requests) serve(request);
    const bool changed = activity_->changes() != told_changes_ || health_.errors() != told_errors_;
    if (changed || std::chrono::steady_clock::now() >= status_due_) publish_status();
}

void RecorderService::serve(const v1::RecorderRequest& request) {
    const auto tell = [&](const Result<void>& outcome, v1::StatusCode refusal) {
        answer(request, outcome ? v1::STATUS_OK : refusal, outcome ? "" : outcome.error().message);
    };
    switch (request.call()._d()) {
        case v1::RECORDER_PAUSE:
            return tell(activity_->pause(true), v1::STATUS_FAILED);
        case v1::RECORDER_RESUME:
            return tell(activity_->pause(false), v1::STATUS_FAILED);
        case v1::RECORDER_SET_RATE: {
            const double rate = request.call().set_rate().rate();
            // Written so that NaN is refused as well.
            if (!(rate == 0 || (rate >= 0.001 && rate <= 1000))) {
                return answer(request, v1::STATUS_INVALID_ARGUMENT,
                              "rate is " + std::to_string(rate) +
                                  "; it must be 0 (as fast as possible) or 0.001 to 1000");
            }
            return tell(activity_->set_rate(rate), v1::STATUS_UNSUPPORTED);
        }
        case v1::RECORDER_NEW_FILE:
            return activity_->new_file(
                [this, request](v1::StatusCode code, const std::string& message) {
                    answer(request, code, message);
                });
        case v1::RECORDER_GET_STATUS:
            return answer(request, v1::STATUS_OK, "");
    }
    // A kind of a later version: the generated code refuses it before it comes here.
    v1::RecorderReply reply;
    reply.header().remote_exception(v1::REMOTE_UNKNOWN_OPERATION);
    reply.outcome().code(v1::STATUS_UNSUPPORTED);
    reply.outcome().message("call: there is no such call");
    server_->answer(request.header().request_id(), std::move(reply));
}

void RecorderService::answer(const v1::RecorderRequest& request, v1::StatusCode code,
                             const std::string& message) {
    v1::RecorderReply reply;
    reply.outcome().code(code);
    reply.outcome().message(bounded(message, 511));
    reply.result(result_of(request.call()._d()));
    if (request.call()._d() == v1::RECORDER_GET_STATUS) reply.result().get_status(status());
    server_->answer(request.header().request_id(), std::move(reply));
}

v1::RecorderStatus RecorderService::status() {
    health_.state(activity_->state(), activity_->status_line());
    v1::RecorderStatus status;
    status.instance(instance_);
    status.health(health_.snapshot(participant_->counts()));
    activity_->fill(status);
    count_peers(participant_->counts(), status.dropped_by());
    if (server_) add_losses(status.dropped_by(), *server_);
    return status;
}

void RecorderService::publish_status() {
    status_due_ = std::chrono::steady_clock::now() + status_period;
    told_changes_ = activity_->changes();
    told_errors_ = health_.errors();
    auto now = status();
    status_writer_->write(now);
}

void RecorderService::stop() {
    activity_->stop();
    if (status_writer_) {
        // The last word: what came of it all. The writer is gone at once after this.
        publish_status();
        status_writer_->wait_acknowledged({0, 200'000'000});
    }
    server_.reset();
    status_writer_.reset();
    participant_.reset();
}

}  // namespace pursuit::recorder
