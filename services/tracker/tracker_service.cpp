// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_service.hpp"

#include <spdlog/spdlog.h>

#include <cstdlib>
#include <utility>

#include "services/common/request_losses.hpp"
#include "services/tracker/start_settings.hpp"

namespace pursuit::tracker {
namespace {

constexpr std::int64_t status_period_ns = 1'000'000'000;

/// Requests that may wait for the core thread; further ones are refused at once.
constexpr std::size_t most_waiting_requests = 256;

std::string store_path(const disk::TrackerConfig& config) {
    if (!config.store().empty()) return config.store();
    // systemd.exec(5): the folders of StateDirectory=, separated by colons.
    const char* folders = std::getenv("STATE_DIRECTORY");
    if (folders == nullptr || *folders == '\0') return "";
    const std::string first(folders);
    return first.substr(0, first.find(':')) + "/tracker.store";
}

v1::TrackerReply refused(CallAnswer answer) {
    v1::TrackerReply reply;
    reply.header().remote_exception(answer.remote_exception);
    reply.outcome(std::move(answer.outcome));
    return reply;
}

}  // namespace

Result<std::unique_ptr<Service>> TrackerService::make(const disk::TrackerConfig& config) {
    auto models = configured_models(config);
    if (!models) return tl::unexpected(models.error());
    auto tried = configured_tracker(config, 1, true);
    if (!tried) return tl::unexpected(tried.error());
    for (std::size_t i = 0; i < models->size(); ++i) {
        const auto registered = tried->register_object((*models)[i]);
        if (!registered) {
            return fail_field("model[" + std::to_string(i) + "]",
                              ": " + (*models)[i].shape.name + ": " + registered.error().message);
        }
    }
    return std::unique_ptr<Service>(new TrackerService(config, std::move(*models)));
}

TrackerService::TrackerService(const disk::TrackerConfig& config, std::vector<Registration> models)
    : config_(config),
      models_(std::move(models)),
      identity_{config.name().empty() ? "default" : config.name(), config.sensor_id()},
      health_(config),
      queue_(config.queue_packets(), most_waiting_requests) {}

Result<void> TrackerService::start() {
    auto participant = Participant::create(config_.dds(), "pursuit-tracker", config_.name());
    if (!participant) return tl::unexpected(participant.error());
    participant_ = std::move(*participant);
    if (auto open = open_writers(); !open) return open;

    const std::string path = store_path(config_);
    FoundStore found;
    if (!path.empty()) {
        auto lock = StoreLock::take(path);
        if (!lock) return tl::unexpected(lock.error());
        store_lock_ = std::move(*lock);
        if (!store_lock_.problem().empty()) health_.error(store_lock_.problem());
        auto read = read_store(path);
        if (!read) return tl::unexpected(read.error());
        found = std::move(*read);
        if (!found.damage.empty()) health_.error(found.damage + "; no object is restored");
    }
    auto& stored = found.state;
    auto tracker = configured_tracker(config_, stored ? stored->next_object_id : 1);
    // make() has tried the configuration: it is the store's number.
    if (!tracker) return fail(path + ": " + tracker.error().message);
    SessionOutputs outputs{
        [this](v1::ObjectPose& pose) { return poses_->write(pose); },
        [this](v1::PoseTrack& track) { return tracks_->write(track); },
        [this](v1::RegisteredModel& model) { return model_writer_->write(model); },
        [this](v1::TrackerSettings& settings) { return settings_->write(settings); },
        [this](v1::RegisteredModel& key) { return model_writer_->forget(key); },
        [this](std::uint32_t object_id) { forget_poses(object_id); },
        [this](const SessionFigures& figures) { return status(figures); },
        [this](const std::string& message) { health_.error(message); },
        [](const PoseRecord& lost) {
            spdlog::warn("object {} is lost at {:.6f} s: {}", lost.model,
                         static_cast<double>(lost.t_us) * 1e-6, to_string(lost.loss_cause));
        },
        [](const std::string& message) { spdlog::warn("{}", message); },
        may_go_on_starting,
    };
    auto session = std::make_unique<TrackerSession>(
        std::move(*tracker), identity_, std::move(stored), models_, clock_, std::move(outputs));
    if (!session->is_whole()) return fail("not all objects were restored");
    store_ = std::make_unique<StoreWriter>(
        path, [this](const std::string& message) { health_.error(message); },
        [] { spdlog::info("the store is written again"); });
    core_ = std::make_unique<CoreThread>(std::move(session), queue_, *store_,
                                         [this](const v1::RequestId& id, v1::TrackerReply reply) {
                                             requests_->answer(id, std::move(reply));
                                         });
    if (auto open = open_readers(); !open) return open;
    core_->start();
    publish_status();
    return {};
}

Result<void> TrackerService::open_writers() {
    const auto open = [&](auto& writer, const char* name) -> Result<void> {
        using WriterType = typename std::remove_reference_t<decltype(writer)>::element_type;
        auto made = WriterType::create(*participant_, name);
        if (!made) return tl::unexpected(made.error());
        writer = std::move(*made);
        return {};
    };
    if (auto ok = open(poses_, topic::poses); !ok) return ok;
    if (config_.pose_tracks()) {
        if (auto ok = open(tracks_, topic::pose_tracks); !ok) return ok;
    }
    if (auto ok = open(model_writer_, topic::models); !ok) return ok;
    if (auto ok = open(settings_, topic::tracker_settings); !ok) return ok;
    return open(status_, topic::tracker_status);
}

Result<void> TrackerService::open_readers() {
    auto requests = Server::create(
        *participant_, topic::tracker_request, topic::tracker_reply, identity_.instance,
        [this](v1::TrackerRequest& request, Server& server) { receive(request, server); });
    if (!requests) return tl::unexpected(requests.error());
    requests_ = std::move(*requests);
    auto events = Reader<v1::EventPacket>::create(
        *participant_, topic::events, [this](v1::EventPacket& packet, const auto&) {
            take_in(packet, identity_.sensor_id, clock_.steady_ns(), queue_, intake_);
        });
    if (!events) return tl::unexpected(events.error());
    events_ = std::move(*events);
    return {};
}

void TrackerService::receive(v1::TrackerRequest& request, Server& server) {
    if (queue_.push_request(request)) return;
    intake_.refused_requests.fetch_add(1);
    server.answer(
        request.header().request_id(),
        refused(refusal(v1::STATUS_LIMIT_EXCEEDED,
                        "requests: " + std::to_string(most_waiting_requests) + " are waiting",
                        v1::REMOTE_OUT_OF_RESOURCES)));
}

void TrackerService::forget_poses(std::uint32_t object_id) {
    v1::ObjectPose pose;
    pose.sensor_id(identity_.sensor_id);
    pose.object_id(object_id);
    poses_->forget(pose);
    if (!tracks_) return;
    v1::PoseTrack track;
    track.sensor_id(identity_.sensor_id);
    track.object_id(object_id);
    tracks_->forget(track);
}

v1::TrackerStatus TrackerService::status(const SessionFigures& figures) {
    v1::TrackerStatus status =
        tracker_status(identity_, figures, queue_.figures(), intake_, clock_);
    add_losses(status.dropped_by(), *requests_);
    const std::string failure = store_ ? store_->failure() : "";
    health_.state(state_of(status, figures, failure), describe(status, figures, failure));
    status.health(health_.snapshot(participant_->counts()));
    count_peers(participant_->counts(), status.dropped_by());
    return status;
}

void TrackerService::tick() {
    const std::int64_t now_ns = clock_.steady_ns();
    if (now_ns - last_store_ns_ >= std::int64_t{config_.store_period_ms()} * 1'000'000) {
        last_store_ns_ = now_ns;
        store_->retry();
        core_->store_poses();
    }
    requests_->tick();
    publish_status();
}

void TrackerService::publish_status() {
    auto now = status(core_->figures());
    if (const auto what = stalled(); !what.empty()) {
        now.health().state(v1::SERVICE_FAULT);
        now.health().detail(what);
    }
    described_ = now.health().detail().to_string();
    const std::int64_t now_ns = clock_.steady_ns();
    const bool changed = now.health().state() != last_state_ || now.objects() != last_objects_ ||
                         now.health().errors() != last_errors_;
    if (!changed && now_ns - last_status_ns_ < status_period_ns) return;
    if (now.sensor_silent() && !was_silent_) spdlog::warn("{}", described_);
    was_silent_ = now.sensor_silent();
    last_status_ns_ = now_ns;
    last_state_ = now.health().state();
    last_objects_ = now.objects();
    last_errors_ = now.health().errors();
    status_->write(now);
}

void TrackerService::count_rest() {
    for (auto& work : queue_.rest()) {
        if (const auto* packet = std::get_if<v1::EventPacket>(&work)) {
            intake_.left_packets.fetch_add(1);
            intake_.left_events.fetch_add(packet->words().size());
            continue;
        }
        intake_.left_requests.fetch_add(1);
        requests_->answer(std::get<v1::TrackerRequest>(work).header().request_id(),
                          refused(refusal(v1::STATUS_FAILED, "the tracker stops")));
    }
    const auto waiting = core_->figures().calls_waiting;
    if (waiting == 0) return;
    health_.error(std::to_string(waiting) +
                  " calls that waited for their time are dropped: the tracker stops");
}

void TrackerService::publish_last_status() {
    // The last word: what came of it all. The writer is gone at once after this.
    auto last = status(core_->figures());
    health_.state(v1::SERVICE_FINISHED, "has stopped");
    last.health(health_.snapshot(participant_->counts()));
    status_->write(last);
    status_->wait_acknowledged({0, 200'000'000});
}

std::string TrackerService::stalled() const {
    return core_->stalled() ? "the core thread has done nothing for 5 s" : "";
}

void TrackerService::stop() {
    // No more work comes in, then none is done, then what was done is kept and told.
    events_.reset();
    if (core_) core_->stop();
    const bool has_served = core_ && requests_;
    if (has_served) count_rest();
    store_.reset();
    if (has_served) publish_last_status();
    requests_.reset();
    core_.reset();
}

}  // namespace pursuit::tracker
