// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/sensor_service.hpp"

#include <chrono>
#include <cmath>

#include "services/common/request_losses.hpp"
#include "services/sensor/event_publisher.hpp"
#include "services/sensor/filter_wire.hpp"
#include "services/sensor/live_publisher.hpp"
#include "services/sensor/source.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::int64_t status_period_ns = 1'000'000'000;
constexpr double slowest_rate = 0.001;
constexpr double fastest_rate = 1000;

/// An error of a chain of filters, which begins with its field.
tl::unexpected<Error> of_field(const Error& error) {
    return tl::unexpected<Error>(Error{"field " + error.message, error.field});
}

PacketOutput output_of(Writer<v1::EventPacket>& writer) {
    return {[&writer](v1::EventPacket& packet) { return writer.write(packet); },
            [&writer](std::chrono::milliseconds at_most) {
                const auto whole = std::chrono::duration_cast<std::chrono::seconds>(at_most);
                const std::chrono::nanoseconds rest = at_most - whole;
                return writer.wait_acknowledged({static_cast<std::int32_t>(whole.count()),
                                                 static_cast<std::uint32_t>(rest.count())});
            },
            [&writer] { return writer.matched(); }};
}

void refuse(v1::SensorReply& reply, v1::StatusCode code, const std::string& message) {
    reply.outcome().code(code);
    reply.outcome().message(bounded(message, 511));
}

}  // namespace

Result<std::unique_ptr<Service>> SensorService::make(const disk::SensorConfig& config) {
    if (config.rate() != 0 && config.rate() < slowest_rate) {
        return fail_field("rate",
                          " is " + std::to_string(config.rate()) + ", must be 0 or at least 0.001");
    }
    auto settings = filters_of(config);
    if (!settings) return tl::unexpected(settings.error());
    auto filters = FilterSwitch::make(std::move(*settings));
    if (!filters) return of_field(filters.error());
    const auto live = is_live(config);
    if (!live) return tl::unexpected(live.error());
    if (const auto good = live_options(config); !good) return tl::unexpected(good.error());
    std::unique_ptr<SensorService> service(new SensorService(config, std::move(*filters)));
    if (*live) {
        auto input = open_live(config);
        if (!input) return tl::unexpected(input.error());
        service->live_ = std::move(*input);
        return service;
    }
    auto source = open_source(config);
    if (!source) return tl::unexpected(source.error());
    if (auto fits = service->filters_->begin((*source)->geometry()); !fits) {
        return of_field(fits.error());
    }
    service->source_ = std::move(*source);
    return service;
}

SensorService::SensorService(const disk::SensorConfig& config,
                             std::unique_ptr<FilterSwitch> filters)
    : config_(config),
      instance_(config.name().empty() ? "default" : config.name()),
      health_(config),
      is_live_(*is_live(config)),
      // A live source sets the pace itself.
      pacer_(clock_, is_live_ ? 0 : config.rate()),
      filters_(std::move(filters)) {}

Result<void> SensorService::start() {
    auto participant =
        Participant::create(config_.dds(), "pursuit-sensor " + instance_, config_.name());
    if (!participant) return tl::unexpected(participant.error());
    participant_ = std::move(*participant);
    auto events = Writer<v1::EventPacket>::create(*participant_, topic::events);
    if (!events) return tl::unexpected(events.error());
    events_ = std::move(*events);
    auto exposures = Writer<v1::EventPacket>::create(*participant_, topic::exposures);
    if (!exposures) return tl::unexpected(exposures.error());
    exposures_ = std::move(*exposures);
    auto status = Writer<v1::SensorStatus>::create(*participant_, topic::sensor_status);
    if (!status) return tl::unexpected(status.error());
    status_ = std::move(*status);
    StreamOutputs outputs{output_of(*events_), output_of(*exposures_),
                          [this](const std::string& message) { health_.error(message); }};
    if (is_live_) {
        publisher_ = std::make_unique<LivePublisher>(config_, std::move(outputs), pacer_, clock_,
                                                     *filters_, std::move(live_));
    } else {
        publisher_ = std::make_unique<EventPublisher>(config_, std::move(outputs), pacer_, clock_,
                                                      *filters_, std::move(source_));
    }
    auto requests = Requests::create(
        *participant_, topic::sensor_request, topic::sensor_reply, instance_,
        [this](v1::SensorRequest& request, auto& server) { receive(request, server); });
    if (!requests) return tl::unexpected(requests.error());
    requests_ = std::move(*requests);
    publisher_->start();
    return {};
}

void SensorService::receive(const v1::SensorRequest& request, Requests& server) {
    if (request.call()._d() == v1::SENSOR_SET_FILTERS) {
        // Files are read and tables filled for it: not on the middleware's thread.
        const std::scoped_lock lock(filter_requests_mutex_);
        filter_requests_.emplace_back(request.header().request_id(), request.call().set_filters());
        return;
    }
    server.answer(request.header().request_id(), serve(request, server));
}

void SensorService::set_filters() {
    std::deque<std::pair<v1::RequestId, v1::SetFilters>> requests;
    {
        const std::scoped_lock lock(filter_requests_mutex_);
        requests.swap(filter_requests_);
    }
    for (const auto& [id, call] : requests) {
        v1::SensorReply reply;
        reply.result().set_filters({});
        auto wanted = filters_of(call);
        if (wanted.code != v1::STATUS_OK) {
            refuse(reply, wanted.code, wanted.message);
        } else if (auto ok = filters_->set(std::move(wanted.settings)); !ok) {
            refuse(reply, v1::STATUS_INVALID_ARGUMENT, "field set_filters." + ok.error().message);
        }
        requests_->answer(id, reply);
        changed_ = true;
    }
}

v1::SensorReply SensorService::serve(const v1::SensorRequest& request, const Requests& server) {
    v1::SensorReply reply;
    const auto kind = request.call()._d();
    switch (kind) {
        case v1::SENSOR_SET_RATE: {
            reply.result().set_rate({});
            const double rate = request.call().set_rate().rate();
            if (is_live_) {
                refuse(reply, v1::STATUS_UNSUPPORTED,
                       "field set_rate.rate: a live source plays at its own pace");
            } else if (!std::isfinite(rate) || rate > fastest_rate ||
                       (rate != 0 && rate < slowest_rate)) {
                refuse(reply, v1::STATUS_INVALID_ARGUMENT,
                       "field set_rate.rate is " + std::to_string(rate) +
                           ", must be 0 or 0.001 to 1000");
            } else {
                pacer_.set_rate(rate);
            }
            break;
        }
        case v1::SENSOR_PAUSE:
            reply.result().pause({});
            pacer_.pause();
            break;
        case v1::SENSOR_RESUME:
            reply.result().resume({});
            pacer_.resume();
            break;
        case v1::SENSOR_GET_STATUS:
            reply.result().get_status(status(server));
            break;
        default:
            reply.result().get_status(status(server));
            reply.header().remote_exception(v1::REMOTE_UNKNOWN_OPERATION);
            refuse(reply, v1::STATUS_UNSUPPORTED,
                   "call " + std::to_string(static_cast<int>(kind)) + " is unknown");
    }
    changed_ = true;
    return reply;
}

v1::ServiceState SensorService::service_state() const {
    switch (publisher_->state()) {
        case Publisher::State::waiting:
            return v1::SERVICE_WAITING;
        case Publisher::State::running:
            return pacer_.paused() ? v1::SERVICE_PAUSED : v1::SERVICE_RUNNING;
        case Publisher::State::finished:
            return v1::SERVICE_FINISHED;
        case Publisher::State::failed:
            break;
    }
    return v1::SERVICE_FAULT;
}

v1::SensorStatus SensorService::status(const Requests& server) const {
    const auto& counts = publisher_->counts();
    v1::SensorStatus status;
    status.instance(instance_);
    status.sensor_id(config_.sensor_id());
    status.health(health_.snapshot(participant_->counts()));
    status.source(bounded(source_name(config_), 255));
    status.stream_id(counts.stream_id);
    status.width(static_cast<std::uint16_t>(counts.size >> 16));
    status.height(static_cast<std::uint16_t>(counts.size & 0xffff));
    status.rate(is_live_ ? 1 : pacer_.rate());
    status.last_t_us(counts.last_t_us);
    status.events_in(counts.events_in);
    status.events_out(counts.events_out);
    status.packets_out(counts.packets_out);
    status.exposures_out(counts.exposures_out);
    std::uint64_t dropped = 0;
    const auto cause = [&](const std::string& name, std::uint64_t count) {
        v1::NamedCount entry;
        entry.name(name);
        entry.count(count);
        status.dropped_by().push_back(entry);
    };
    const auto events = [&](const std::string& name, std::uint64_t count) {
        cause(name, count);
        dropped += count;
    };
    events("events.write_failed", counts.events_unsent);
    events("events.unsent_at_stop", counts.events_left);
    for (std::size_t kind = 0; kind < counts.filtered.size(); ++kind) {
        events("filter." + std::string(filter_kinds()[kind].name), counts.filtered[kind]);
    }
    for (const auto& [name, count] : publisher_->losses()) events(name, count);
    status.events_dropped(dropped);
    // Not of events.
    cause("exposures.write_failed", counts.exposures_unsent);
    cause("exposures.queue_full", counts.exposures_overtaken);
    cause("exposures.unsent_at_stop", counts.exposures_left);
    cause("packets.unacknowledged", counts.packets_unacknowledged);
    add_losses(status.dropped_by(), server);
    count_peers(participant_->counts(), status.dropped_by());
    status.event_rate_hz(event_rate_hz_);
    status.lag_us(static_cast<double>(pacer_.lag_us()));
    status.host_clock_drift_ppm(publisher_->drift_ppm());
    status.subscribers(static_cast<std::uint32_t>(events_->matched()));
    return status;
}

void SensorService::tick() {
    set_filters();
    requests_->tick();
    const auto now_ns = clock_.steady_ns();
    const auto state = service_state();
    const bool due = now_ns - last_status_ns_ >= status_period_ns;
    if (!due && !changed_.exchange(false) && state == last_state_) return;
    if (due) {
        const auto events_out = publisher_->counts().events_out.load();
        const auto period_ns = static_cast<double>(now_ns - last_status_ns_);
        event_rate_hz_ =
            last_status_ns_ == 0
                ? 0.0
                : static_cast<double>(events_out - events_at_last_status_) * 1e9 / period_ns;
        events_at_last_status_ = events_out;
        last_status_ns_ = now_ns;
    }
    last_state_ = state;
    health_.state(state, status_line());
    auto sample = status(*requests_);
    status_->write(sample);
}

bool SensorService::finished() const {
    const auto state = publisher_->state();
    return config_.exit_at_end() &&
           (state == Publisher::State::finished || state == Publisher::State::failed);
}

bool SensorService::failed() const {
    return publisher_ != nullptr && publisher_->state() == Publisher::State::failed;
}

std::string SensorService::status_line() const {
    const auto remark = publisher_->remark();
    switch (publisher_->state()) {
        case Publisher::State::waiting:
            return "waiting for " + remark;
        case Publisher::State::running:
            return (pacer_.paused() ? "paused: " : "publishing ") + source_name(config_) +
                   (filters_->names().empty() ? "" : " through " + filters_->names()) +
                   (remark.empty() ? "" : ", " + remark);
        case Publisher::State::finished:
            return "finished " + source_name(config_);
        case Publisher::State::failed:
            break;
    }
    return "the source failed: " + source_name(config_);
}

void SensorService::stop() {
    if (publisher_) publisher_->stop();
    // Made last: without it nothing was sent.
    if (requests_) {
        // The last word: what was sent in all.
        health_.state(publisher_->state() == Publisher::State::failed ? v1::SERVICE_FAULT
                                                                      : v1::SERVICE_FINISHED,
                      status_line());
        auto sample = status(*requests_);
        status_->write(sample);
        status_->wait_acknowledged({0, 200'000'000});
    }
    requests_.reset();
    publisher_.reset();
    status_.reset();
    events_.reset();
    exposures_.reset();
    participant_.reset();
}

}  // namespace pursuit::sensor
