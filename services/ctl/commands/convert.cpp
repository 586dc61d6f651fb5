// SPDX-License-Identifier: Apache-2.0
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <vector>

#include "services/ctl/commands/offline_commands.hpp"
#include "services/ctl/commands/option_values.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/sensor/formats/formats.hpp"
#include "services/sensor/range_reader.hpp"

namespace pursuit::ctl {
namespace {

struct Options {
    std::string from;
    std::string to;
    std::string format;
    std::string geometry;
    double from_s = 0;
    double to_s = 0;
};

/// Copies all events; where the recording ends in an error, those before it.
Result<void> copy(sensor::EventReader& recording, sensor::EventWriter& writer) {
    std::vector<Event> block(8192);
    for (;;) {
        const auto count = recording.read(block);
        if (!count || *count == 0) {
            if (auto ok = writer.close(); !ok) return ok;
            return count ? Result<void>{} : tl::unexpected(count.error());
        }
        if (auto ok = writer.write(std::span(block).first(*count)); !ok) return ok;
    }
}

int convert(const Options& options) {
    const auto geometry = geometry_of(options.geometry);
    if (!geometry) return report(geometry.error());
    const auto range = sensor::range_of_seconds(options.from_s, options.to_s);
    if (!range) return report(range.error());
    auto recording = sensor::open_events(options.from, {options.format, *geometry});
    if (!recording) return report(recording.error());
    const auto events = sensor::in_range(std::move(*recording), *range);
    auto writer = sensor::create_events(options.to, events->geometry());
    if (!writer) return report(writer.error());
    const auto copied = copy(*events, **writer);
    std::printf("%" PRIu64 " events\n", (*writer)->events_written());
    return copied ? exit_success : report(copied.error());
}

}  // namespace

Run define_convert(CLI::App& app) {
    auto options = std::make_shared<Options>();
    app.add_option("FROM", options->from, "Recording of events")->required();
    app.add_option("TO", options->to, "File to write; its extension is its format")->required();
    app.add_option("--format", options->format, "Format of FROM, where the file does not tell");
    app.add_option("--geometry", options->geometry, geometry_help);
    app.add_option("--from", options->from_s, "Begin here, seconds of the recording's time");
    app.add_option("--to", options->to_s, "End before here; 0: to the end");
    return [options] { return convert(*options); };
}

}  // namespace pursuit::ctl
