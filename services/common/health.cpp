// SPDX-License-Identifier: Apache-2.0
#include "services/common/health.hpp"

#include <spdlog/spdlog.h>
#include <sys/timex.h>
#include <unistd.h>
#include <zlib.h>

#include <chrono>
#include <cstdio>

namespace pursuit {
namespace {

std::int64_t host_time_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

std::string digest_of(const google::protobuf::Message& message) {
    const std::string text = message.DebugString();
    const auto crc =
        ::crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size()));
    char digest[9];
    std::snprintf(digest, sizeof digest, "%08lx", static_cast<unsigned long>(crc));
    return digest;
}

}  // namespace

void count_peers(const TransportCounts& counts, std::vector<v1::NamedCount>& dropped_by) {
    constexpr const char* cause = "peers.incompatible_qos";
    for (auto& known : dropped_by) {
        if (known.name().to_string() != cause) continue;
        known.count(known.count() + counts.incompatible.load());
        return;
    }
    v1::NamedCount count;
    count.name(cause);
    count.count(counts.incompatible.load());
    dropped_by.push_back(count);
}

std::string bounded(const std::string& text, std::size_t bytes) { return text.substr(0, bytes); }

const char* version() { return PURSUIT_VERSION; }

Health::Health(const google::protobuf::Message& configuration)
    : configuration_digest_(digest_of(configuration)), start_host_time_ns_(host_time_ns()) {}

void Health::state(v1::ServiceState state, const std::string& detail) {
    const std::scoped_lock lock(mutex_);
    state_ = state;
    detail_ = detail;
}

void Health::error(const std::string& message) {
    spdlog::error("{}", message);
    errors_.fetch_add(1);
    const std::scoped_lock lock(mutex_);
    last_error_ = message;
    last_error_host_time_ns_ = host_time_ns();
}

v1::ServiceHealth Health::snapshot(const TransportCounts& counts) const {
    v1::ServiceHealth health;
    {
        const std::scoped_lock lock(mutex_);
        health.state(state_);
        health.detail(bounded(detail_, 255));
        health.last_error(bounded(last_error_, 511));
        health.last_error_host_time_ns(last_error_host_time_ns_);
    }
    health.version(version());
    health.errors(errors_.load());
    health.configuration_digest(configuration_digest_);
    health.start_host_time_ns(start_host_time_ns_);
    health.process_id(static_cast<std::uint32_t>(::getpid()));
    health.malformed_samples(counts.malformed->load());
    health.lost_samples(counts.lost.load() + counts.rejected.load());
    timex clock{};
    const int state = ::adjtimex(&clock);
    health.clock_state(state < 0 ? v1::CLOCK_UNKNOWN
                       : state == TIME_ERROR || (clock.status & STA_UNSYNC) != 0
                           ? v1::CLOCK_UNSYNCHRONISED
                           : v1::CLOCK_SYNCHRONISED);
    health.clock_estimated_error_us(state < 0 ? 0.0 : static_cast<double>(clock.esterror));
    return health;
}

}  // namespace pursuit
