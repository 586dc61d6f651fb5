// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/stream_renewal.hpp"

#include <algorithm>

namespace pursuit::recorder {
namespace {

/// A packet is sent at most so long after its events; more is a clock that was set.
constexpr std::int64_t most_host_lag_ns = 1'000'000'000;

}  // namespace

void StreamRenewal::renew(std::span<std::uint8_t> payload, const PacketFields& packet,
                          std::int64_t log_time_ns, const ReplayPace::Due& due) {
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

}  // namespace pursuit::recorder
