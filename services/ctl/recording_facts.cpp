// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/recording_facts.hpp"

#include <algorithm>
#include <array>

namespace pursuit::ctl {
namespace {

constexpr std::size_t most_bins = 64;

/// Counts into bins that double their width whenever time outgrows them: one pass, bounded memory.
void count(RecordingFacts& facts, std::int64_t t_us) {
    auto bin = static_cast<std::size_t>((t_us - facts.first_t_us) / facts.bin_us);
    while (bin >= most_bins) {
        auto& bins = facts.events_per_bin;
        bins.resize(most_bins);
        for (std::size_t i = 0; i < most_bins / 2; ++i) bins[i] = bins[2 * i] + bins[2 * i + 1];
        bins.resize(most_bins / 2);
        facts.bin_us *= 2;
        bin = static_cast<std::size_t>((t_us - facts.first_t_us) / facts.bin_us);
    }
    if (bin >= facts.events_per_bin.size()) facts.events_per_bin.resize(bin + 1);
    ++facts.events_per_bin[bin];
}

void add(RecordingFacts& facts, const Event& event) {
    if (facts.events == 0) {
        facts.first_t_us = event.t_us;
        facts.last_t_us = event.t_us;
        facts.x_min = facts.x_max = event.x;
        facts.y_min = facts.y_max = event.y;
    }
    if (event.t_us - facts.last_t_us > facts.longest_gap_us) {
        facts.longest_gap_us = event.t_us - facts.last_t_us;
        facts.gap_t_us = facts.last_t_us;
    }
    facts.silences += event.t_us - facts.last_t_us >= silence_us ? 1 : 0;
    facts.last_t_us = event.t_us;
    facts.x_min = std::min(facts.x_min, event.x);
    facts.x_max = std::max(facts.x_max, event.x);
    facts.y_min = std::min(facts.y_min, event.y);
    facts.y_max = std::max(facts.y_max, event.y);
    ++facts.events;
    facts.on_events += event.polarity;
    count(facts, event.t_us);
}

}  // namespace

RecordingFacts facts_of(sensor::EventReader& recording) {
    RecordingFacts facts;
    facts.geometry = recording.geometry();
    std::vector<Event> events(8192);
    std::vector<Event> exposures(8192);
    for (;;) {
        const auto batch = recording.read(events, exposures);
        facts.events_skipped = recording.events_skipped();
        facts.exposures = recording.exposures_read();
        if (!batch) {
            facts.fault = batch.error().message;
            return facts;
        }
        if (batch->at_end) return facts;
        for (std::size_t i = 0; i < batch->events; ++i) add(facts, events[i]);
    }
}

std::string rate_picture(const RecordingFacts& facts) {
    constexpr std::array<const char*, 9> blocks = {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
    std::uint64_t most = 1;
    for (const auto events : facts.events_per_bin) most = std::max(most, events);
    std::string picture;
    // A bin with any event is never blank.
    for (const auto events : facts.events_per_bin)
        picture += blocks[(events * 8 + most - 1) / most];
    return picture;
}

}  // namespace pursuit::ctl
