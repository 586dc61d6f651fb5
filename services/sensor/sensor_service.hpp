// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "config.pb.h"
#include "services/common/clock.hpp"
#include "services/common/health.hpp"
#include "services/common/request_server.hpp"
#include "services/common/service_main.hpp"
#include "services/common/writer.hpp"
#include "services/sensor/formats/event_reader.hpp"
#include "services/sensor/live/live_input.hpp"
#include "services/sensor/pacer.hpp"
#include "services/sensor/publisher.hpp"

namespace pursuit::sensor {

/// The DDS shell of the sensor: publishes the events and exposure measurements of one source, its
/// own status at 1 Hz and on change, and serves the calls of idl/sensor_requests.idl.
///
/// Threads: as Service; calls come on the middleware's thread and only set the pacer, or leave
/// filters to be made by the next tick().
class SensorService final : public Service {
 public:
    /// Opens the source; an error is one of the configuration.
    static Result<std::unique_ptr<Service>> make(const disk::SensorConfig& config);

    Result<void> start() override;
    void tick() override;
    bool finished() const override;
    bool failed() const override;
    std::string status_line() const override;
    void stop() override;

 private:
    using Requests = RequestServer<v1::SensorRequest, v1::SensorReply>;

    SensorService(const disk::SensorConfig& config, std::unique_ptr<FilterSwitch> filters);

    void receive(const v1::SensorRequest& request, Requests& server);
    v1::SensorReply serve(const v1::SensorRequest& request, const Requests& server);
    void set_filters();
    /// `server`: the one of requests_; a request may come before it is there.
    v1::SensorStatus status(const Requests& server) const;
    v1::ServiceState service_state() const;

    const disk::SensorConfig config_;
    const std::string instance_;
    SystemClock clock_;
    Health health_;
    const bool is_live_;
    Pacer pacer_;
    std::unique_ptr<FilterSwitch> filters_;
    std::unique_ptr<EventReader> source_;  // until start(): one of the two
    std::unique_ptr<LiveInput> live_;
    std::unique_ptr<Participant> participant_;
    std::unique_ptr<Writer<v1::EventPacket>> events_;
    std::unique_ptr<Writer<v1::EventPacket>> exposures_;
    std::unique_ptr<Writer<v1::SensorStatus>> status_;
    std::unique_ptr<Publisher> publisher_;
    std::unique_ptr<Requests> requests_;
    std::mutex filter_requests_mutex_;
    std::deque<std::pair<v1::RequestId, v1::SetFilters>> filter_requests_;  // for the next tick()
    std::atomic<bool> changed_{true};
    std::int64_t last_status_ns_ = 0;
    std::uint64_t events_at_last_status_ = 0;
    double event_rate_hz_ = 0;
    v1::ServiceState last_state_ = v1::SERVICE_STARTING;
};

}  // namespace pursuit::sensor
