// SPDX-License-Identifier: Apache-2.0
#include <cinttypes>
#include <cstdio>
#include <memory>

#include "services/ctl/commands/mcap_info.hpp"
#include "services/ctl/commands/offline_commands.hpp"
#include "services/ctl/commands/option_values.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/ctl/recording_facts.hpp"
#include "services/sensor/formats/formats.hpp"

namespace pursuit::ctl {
namespace {

struct InfoOptions {
    std::string events;
    std::string format;
    std::string geometry;
    bool full = false;
    bool json = false;
};

void print(const RecordingFacts& facts) {
    const double duration_s = static_cast<double>(facts.last_t_us - facts.first_t_us) * 1e-6;
    std::printf("pixels    %ux%u\n", unsigned{facts.geometry.width},
                unsigned{facts.geometry.height});
    std::printf("events    %" PRIu64 "\n", facts.events);
    if (facts.events_skipped > 0) {
        std::printf("skipped   %" PRIu64 " events without time, or of another camera\n",
                    facts.events_skipped);
    }
    if (facts.exposures > 0) {
        std::printf("exposures %" PRIu64 " measurements\n", facts.exposures);
    }
    if (facts.events == 0) return;
    const double on_pct =
        100 * static_cast<double>(facts.on_events) / static_cast<double>(facts.events);
    std::printf("polarity  %" PRIu64 " ON (%.1f %%), %" PRIu64 " OFF\n", facts.on_events, on_pct,
                facts.events - facts.on_events);
    std::printf("time      %" PRId64 " to %" PRId64 " us, %.6f s\n", facts.first_t_us,
                facts.last_t_us, duration_s);
    std::printf("x, y      %u to %u, %u to %u\n", unsigned{facts.x_min}, unsigned{facts.x_max},
                unsigned{facts.y_min}, unsigned{facts.y_max});
    std::printf("silence   at most %" PRId64 " us, from %" PRId64 " us; %" PRIu64
                " of 100 ms or more\n",
                facts.longest_gap_us, facts.gap_t_us, facts.silences);
    if (duration_s > 0) {
        std::printf("rate      %.0f events/s, over time in steps of %.4g ms:\n",
                    static_cast<double>(facts.events) / duration_s,
                    static_cast<double>(facts.bin_us) * 1e-3);
        std::printf("          |%s|\n", rate_picture(facts).c_str());
    }
}

int info(const InfoOptions& options) {
    if (is_mcap(options.events)) return print_mcap_info(options.events, options.full, options.json);
    if (options.json || options.full) {
        return report({options.events + ": no MCAP recording; --json and --full are for those"});
    }
    const auto geometry = geometry_of(options.geometry);
    if (!geometry) return report(geometry.error());
    auto recording = sensor::open_events(options.events, {options.format, *geometry});
    if (!recording) return report(recording.error());
    const auto facts = facts_of(**recording);
    print(facts);
    return facts.fault.empty() ? exit_success : report({facts.fault});
}

}  // namespace

Run define_info(CLI::App& app) {
    auto options = std::make_shared<InfoOptions>();
    app.add_option("FILE", options->events, "Recording: of events, or of topics (MCAP)")
        ->required();
    app.add_option("--format", options->format, format_help());
    app.add_option("--geometry", options->geometry, geometry_help);
    app.add_flag("--full", options->full, "MCAP: read everything and check it");
    app.add_flag("--json", options->json, "MCAP: as one JSON object");
    return [options] { return info(*options); };
}

}  // namespace pursuit::ctl
