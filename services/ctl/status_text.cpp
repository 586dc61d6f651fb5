// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/status_text.hpp"

#include <array>
#include <cstdarg>
#include <cstdio>
#include <vector>

#include "services/ctl/json_text.hpp"

namespace pursuit::ctl {
namespace {

std::string clock_name(v1::ClockState state) {
    constexpr std::array names{"UNKNOWN", "UNSYNCHRONISED", "SYNCHRONISED"};
    return state < names.size() ? names[state] : "?";
}

void add_health(JsonObject& json, const v1::ServiceHealth& health) {
    json.add("version", health.version().to_string())
        .add("state", state_name(health.state()))
        .add("detail", health.detail().to_string())
        .add("last_error", health.last_error().to_string())
        .add("last_error_host_time_ns", health.last_error_host_time_ns())
        .add("errors", health.errors())
        .add("configuration_digest", health.configuration_digest().to_string())
        .add("start_host_time_ns", health.start_host_time_ns())
        .add("process_id", health.process_id())
        .add("clock_state", clock_name(health.clock_state()))
        .add("clock_estimated_error_us", health.clock_estimated_error_us())
        .add("malformed_samples", health.malformed_samples())
        .add("lost_samples", health.lost_samples());
}

std::string counts_json(const std::vector<v1::NamedCount>& counts) {
    JsonObject json;
    for (const auto& count : counts) json.add(count.name().to_string(), count.count());
    return json.text();
}

// The format is checked by the compiler, as printf's.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

unsigned long long number(std::uint64_t value) { return value; }

std::string headline(const char* service, const std::string& instance,
                     const v1::ServiceHealth& health) {
    std::string text = format("%-9s %-12s %-9s %s\n", service, instance.c_str(),
                              state_name(health.state()).c_str(), health.detail().c_str());
    if (health.errors() > 0) {
        text += format("          %llu errors, the last: %s\n", number(health.errors()),
                       health.last_error().c_str());
    }
    if (health.malformed_samples() + health.lost_samples() > 0) {
        text += format("          samples malformed %llu, lost %llu\n",
                       number(health.malformed_samples()), number(health.lost_samples()));
    }
    return text;
}

/// Event time; below 0 there is none yet.
std::string at_time(std::int64_t t_us) {
    if (t_us < 0) return "before the first event";
    return format("at %.3f s", static_cast<double>(t_us) * 1e-6);
}

/// Why objects were lost is among the causes, and is nothing that was dropped.
constexpr std::string_view of_lost = "objects.lost.";

/// The causes that counted anything, or nothing: those that begin with `with`, less that, or,
/// without, those that are nothing of the objects'.
std::string causes(const std::vector<v1::NamedCount>& counts, std::string_view with = "") {
    std::string text;
    for (const auto& count : counts) {
        const std::string name = count.name().to_string();
        const bool is_wanted = with.empty() ? !name.starts_with(of_lost) : name.starts_with(with);
        if (count.count() == 0 || !is_wanted) continue;
        text += (text.empty() ? " (" : ", ") + name.substr(with.size()) + " " +
                number_text(count.count());
    }
    return text.empty() ? text : text + ")";
}

}  // namespace

std::string state_name(v1::ServiceState state) {
    constexpr std::array names{"STARTING", "WAITING", "RUNNING", "PAUSED", "FINISHED", "FAULT"};
    return state < names.size() ? names[state] : "?";
}

std::string status_json(const v1::SensorStatus& status) {
    JsonObject json;
    json.add("instance", status.instance().to_string()).add("sensor_id", status.sensor_id());
    add_health(json, status.health());
    json.add("source", status.source().to_string())
        .add("stream_id", status.stream_id())
        .add("width", status.width())
        .add("height", status.height())
        .add("rate", status.rate())
        .add("last_t_us", status.last_t_us())
        .add("events_in", status.events_in())
        .add("events_out", status.events_out())
        .add("packets_out", status.packets_out())
        .add("exposures_out", status.exposures_out())
        .add("events_dropped", status.events_dropped())
        .raw("dropped_by", counts_json(status.dropped_by()))
        .add("event_rate_hz", status.event_rate_hz())
        .add("lag_us", status.lag_us())
        .add("host_clock_drift_ppm", status.host_clock_drift_ppm())
        .add("subscribers", status.subscribers());
    return json.text();
}

std::string status_json(const v1::TrackerStatus& status) {
    JsonObject latency;
    latency.add("p50_us", status.latency().p50_us())
        .add("p90_us", status.latency().p90_us())
        .add("p99_us", status.latency().p99_us())
        .add("max_us", status.latency().max_us())
        .add("samples", status.latency().samples());
    JsonObject json;
    json.add("instance", status.instance().to_string()).add("sensor_id", status.sensor_id());
    add_health(json, status.health());
    json.add("stream_id", status.stream_id())
        .add("last_t_us", status.last_t_us())
        .add("events_in", status.events_in())
        .add("events_used", status.events_used())
        .add("events_dropped", status.events_dropped())
        .raw("dropped_by", counts_json(status.dropped_by()))
        .add("packets_in", status.packets_in())
        .add("gaps", status.gaps())
        .add("packets_missed", status.packets_missed())
        .add("requests", status.requests())
        .add("requests_refused", status.requests_refused())
        .add("poses_out", status.poses_out())
        .add("poses_thinned", status.poses_thinned())
        .add("queue_packets", status.queue_packets())
        .add("queue_packets_max", status.queue_packets_max())
        .add("queue_capacity", status.queue_capacity())
        .add("objects", status.objects())
        .add("objects_tracking", status.objects_tracking())
        .add("objects_lost", status.objects_lost())
        .add("sensor_silent", status.sensor_silent())
        .add("lag_us", status.lag_us())
        .add("busy_fraction", status.busy_fraction())
        .raw("latency", latency.text());
    return json.text();
}

std::string status_json(const v1::RecorderStatus& status) {
    JsonObject topics;
    for (const auto& topic : status.topics()) {
        JsonObject one;
        one.add("messages", topic.messages()).add("bytes", topic.bytes()).add("lost", topic.lost());
        topics.raw(topic.topic().to_string(), one.text());
    }
    JsonObject json;
    json.add("instance", status.instance().to_string());
    add_health(json, status.health());
    json.add("replaying", status.replaying())
        .add("file", status.file().to_string())
        .add("bytes_written", status.bytes_written())
        .add("chunks_written", status.chunks_written())
        .add("last_flush_host_time_ns", status.last_flush_host_time_ns())
        .add("messages", status.messages())
        .add("messages_dropped", status.messages_dropped())
        .raw("dropped_by", counts_json(status.dropped_by()))
        .add("queue_bytes", status.queue_bytes())
        .add("queue_capacity_bytes", status.queue_capacity_bytes())
        .add("gaps", status.gaps())
        .add("rate", status.rate())
        .raw("topics", topics.text());
    return json.text();
}

std::string status_lines(const v1::SensorStatus& status) {
    return headline("sensor", status.instance().to_string(), status.health()) +
           format("          %s, %u x %u px, rate %g, %s\n", status.source().c_str(),
                  status.width(), status.height(), status.rate(),
                  at_time(status.last_t_us()).c_str()) +
           format("          events in %llu, out %llu (%.0f/s), packets %llu, dropped %llu",
                  number(status.events_in()), number(status.events_out()), status.event_rate_hz(),
                  number(status.packets_out()), number(status.events_dropped())) +
           causes(status.dropped_by()) + "\n";
}

std::string status_lines(const v1::TrackerStatus& status) {
    return headline("tracker", status.instance().to_string(), status.health()) +
           format("          events in %llu, used %llu, dropped %llu", number(status.events_in()),
                  number(status.events_used()), number(status.events_dropped())) +
           causes(status.dropped_by()) +
           format("\n          packets %llu, gaps %llu, missed %llu; queue %u, at most %u of %u\n",
                  number(status.packets_in()), number(status.gaps()),
                  number(status.packets_missed()), status.queue_packets(),
                  status.queue_packets_max(), status.queue_capacity()) +
           format("          objects %u, tracking %u, lost %u", status.objects(),
                  status.objects_tracking(), status.objects_lost()) +
           causes(status.dropped_by(), of_lost) +
           format("; poses %llu, thinned %llu\n", number(status.poses_out()),
                  number(status.poses_thinned())) +
           format("          %s; busy %.1f %%; latency p50 %.0f, p99 %.0f, max %.0f us\n",
                  at_time(status.last_t_us()).c_str(), status.busy_fraction() * 100,
                  status.latency().p50_us(), status.latency().p99_us(), status.latency().max_us());
}

std::string status_lines(const v1::RecorderStatus& status) {
    return headline("recorder", status.instance().to_string(), status.health()) +
           format("          %s %s\n", status.replaying() ? "replays" : "records to",
                  status.file().c_str()) +
           format("          messages %llu, dropped %llu", number(status.messages()),
                  number(status.messages_dropped())) +
           causes(status.dropped_by()) +
           format("; bytes %llu, chunks %llu; gaps %llu\n", number(status.bytes_written()),
                  number(status.chunks_written()), number(status.gaps()));
}

}  // namespace pursuit::ctl
