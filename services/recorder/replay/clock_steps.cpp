// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/clock_steps.hpp"

#include <algorithm>

namespace pursuit::recorder {
namespace {

constexpr std::size_t most_streams = 1024;

/// Of times from a file, which may be any: more than fits wraps around.
std::int64_t sum(std::int64_t a, std::int64_t b) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

std::int64_t difference(std::int64_t a, std::int64_t b) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

}  // namespace

void ClockSteps::take(std::int64_t log_time_ns, const std::optional<PacketFields>& packet) {
    const auto message = messages_++;
    const auto by_ns = message == 0 ? 0 : difference(log_time_ns, log_time_ns_);
    log_time_ns_ = log_time_ns;
    const bool back = by_ns < -least_back_ns;
    if ((back || by_ns > least_forward_ns) && jumps_.size() < most_steps) {
        jumps_.push_back({message, by_ns, back});
    }
    if (!packet) return;
    const auto base_time_us = packet->base_time_us();
    const auto [last, first] = streams_.try_emplace(packet->stream_id());
    if (!first) judge(last->second, base_time_us);
    last->second = {message, base_time_us};
    // Ids are those of their time: the lowest is the oldest.
    if (streams_.size() > most_streams) streams_.erase(streams_.begin());
}

/// Judges the jumps since the last packet of a stream whose next one is of `base_time_us`.
void ClockSteps::judge(const Last& last, std::int64_t base_time_us) {
    const auto events_us = difference(base_time_us, last.base_time_us);
    for (auto jump = jumps_.rbegin(); jump != jumps_.rend(); ++jump) {
        if (jump->message <= last.message) break;
        if (events_us < jump->by_ns / 1000 / 2) jump->step = true;
    }
}

std::vector<ClockStep> ClockSteps::steps() const {
    std::vector<ClockStep> steps;
    std::int64_t shift_ns = 0;
    for (const auto& jump : jumps_) {
        if (!jump.step) continue;
        shift_ns = difference(shift_ns, jump.by_ns);
        steps.push_back({jump.message, shift_ns});
    }
    return steps;
}

std::int64_t SteppedTime::next(std::int64_t log_time_ns) {
    const auto message = messages_++;
    while (passed_ < steps_.size() && steps_[passed_].message <= message) ++passed_;
    return passed_ == 0 ? log_time_ns : sum(log_time_ns, steps_[passed_ - 1].shift_ns);
}

}  // namespace pursuit::recorder
