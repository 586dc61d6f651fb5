// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_status.hpp"

#include <string>

namespace pursuit::tracker {
namespace {

constexpr std::int64_t silence_ns = 100'000'000;

}  // namespace

bool is_silent(const SessionFigures& figures, const IntakeCounters& intake,
               std::int64_t steady_ns) {
    return figures.stream_open && !intake.stream_ended &&
           steady_ns - intake.last_packet_steady_ns > silence_ns;
}

v1::TrackerStatus tracker_status(const ServiceIdentity& identity, const SessionFigures& figures,
                                 const QueueFigures& queue, const IntakeCounters& intake,
                                 Clock& clock) {
    v1::TrackerStatus status;
    status.instance(identity.instance);
    status.sensor_id(identity.sensor_id);
    status.stream_id(figures.stream_id);
    status.last_t_us(figures.last_t_us);

    const auto& tracker = figures.tracker;
    const std::uint64_t queue_full = intake.dropped_events;
    const std::uint64_t left_at_stop = intake.left_events;
    const auto count = [&](const char* cause, std::uint64_t number) {
        v1::NamedCount named;
        named.name(cause);
        named.count(number);
        status.dropped_by().push_back(named);
    };
    const auto dropped = [&](const char* cause, std::uint64_t events) {
        count(cause, events);
        status.events_dropped(status.events_dropped() + events);
    };
    dropped("queue_full", queue_full);
    dropped("left_at_stop", left_at_stop);
    dropped("other_geometry", figures.dropped_bad_geometry);
    dropped("outside_geometry", tracker.dropped_outside_geometry);
    dropped("time_went_back", tracker.dropped_time_went_back);
    dropped("time_out_of_range", tracker.dropped_time_out_of_range);
    // Not events of this stream, and not among the total: packets and requests.
    count("packets.queue_full", intake.dropped_packets);
    count("packets.left_at_stop", intake.left_packets);
    count("packets.old", figures.stream.old);
    count("packets.other_sensor", intake.of_another_sensor);
    count("packets.other_stream", figures.stream.of_another_stream);
    count("packets.other_geometry", figures.stream.bad_geometry);
    count("requests.queue_full", intake.refused_requests);
    count("requests.left_at_stop", intake.left_requests);
    count("requests.refused_at_their_time", figures.late_refusals);
    count("writes.failed", figures.write_failures);
    // How often an object was lost, and why.
    for (std::size_t i = 1; i < tracker.lost_by.size(); ++i) {
        count(("objects.lost." + std::string(to_string(static_cast<LossCause>(i)))).c_str(),
              tracker.lost_by[i]);
    }

    status.events_in(tracker.events_in + queue_full + left_at_stop + figures.dropped_bad_geometry);
    status.events_used(tracker.events_used);
    status.packets_in(figures.stream.packets);
    status.gaps(figures.stream.gaps);
    status.packets_missed(figures.stream.packets_missed);
    const std::uint64_t unasked = intake.refused_requests + intake.left_requests;
    status.requests(figures.requests + unasked);
    status.requests_refused(figures.requests_refused + unasked);
    status.poses_out(figures.poses_out);
    status.poses_thinned(tracker.poses_thinned);
    status.queue_packets(static_cast<std::uint32_t>(queue.packets));
    status.queue_packets_max(static_cast<std::uint32_t>(queue.packets_max));
    status.queue_capacity(static_cast<std::uint32_t>(queue.capacity));
    status.objects(figures.objects);
    status.objects_tracking(figures.objects_tracking);
    status.objects_lost(figures.objects_lost);
    status.sensor_silent(is_silent(figures, intake, clock.steady_ns()));
    if (figures.last_host_time_ns != 0) {
        status.lag_us(static_cast<double>(figures.taken_host_time_ns - figures.last_host_time_ns) *
                      1e-3);
    }
    status.busy_fraction(figures.busy_fraction);
    status.latency(figures.latency);
    return status;
}

v1::ServiceState state_of(const v1::TrackerStatus& status, const SessionFigures& figures,
                          const std::string& store_failure) {
    if (status.sensor_silent() || !store_failure.empty()) return v1::SERVICE_FAULT;
    return figures.stream_open ? v1::SERVICE_RUNNING : v1::SERVICE_WAITING;
}

std::string describe(const v1::TrackerStatus& status, const SessionFigures& figures,
                     const std::string& store_failure) {
    const std::string sensor = "sensor " + std::to_string(status.sensor_id());
    const std::string objects = std::to_string(status.objects()) + " objects";
    std::string line;
    if (status.sensor_silent()) {
        line = sensor + " is silent: no packet for 100 ms";
    } else if (figures.stream_open) {
        line = "follows " + objects + " in the events of " + sensor;
    } else {
        line = (status.packets_in() == 0 ? "waits for events of " : "waits for a new stream of ") +
               sensor + ", " + objects + " registered";
    }
    if (figures.calls_waiting > 0) {
        line += "; " + std::to_string(figures.calls_waiting) + " calls wait for their time";
    }
    if (!store_failure.empty()) line += "; the store is not written: " + store_failure;
    return line;
}

}  // namespace pursuit::tracker
