// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "services/common/output_file.hpp"
#include "services/ctl/commands/offline_commands.hpp"
#include "services/ctl/commands/option_values.hpp"
#include "services/ctl/commands/report.hpp"
#include "services/sensor/formats/formats.hpp"
#include "services/sensor/range_reader.hpp"

namespace pursuit::ctl {
namespace {

struct ConvertOptions {
    std::string from;
    std::string to;
    std::string format;
    std::string geometry;
    double from_s = 0;
    double to_s = 0;
    bool from_zero = false;
};

/// What is read at a time.
struct Block {
    std::vector<Event> events = std::vector<Event>(8192);
    std::vector<Event> exposures = std::vector<Event>(8192);
    Result<sensor::EventReader::Batch> batch = sensor::EventReader::Batch{};

    bool ends() const { return !batch || batch->at_end; }
    bool is_empty() const { return batch->events + batch->exposures == 0; }
};

/// The next events or measurements, or the end.
void read_next(sensor::EventReader& recording, Block& block) {
    do {
        block.batch = recording.read(block.events, block.exposures);
    } while (!block.ends() && block.is_empty());
}

/// Copies `block` and all events after it, and exposure measurements where the writer holds them;
/// where the recording ends in an error, those before it. from_zero: the first of either is at time
/// 0.
Result<void> copy(Block& block, sensor::EventReader& recording, sensor::EventWriter& writer,
                  bool from_zero) {
    std::optional<std::int64_t> zero_us;
    const auto shift = [&](std::span<Event> part) {
        for (auto& event : part) event.t_us -= *zero_us;
    };
    for (; !block.ends(); read_next(recording, block)) {
        const auto read_events = std::span(block.events).first(block.batch->events);
        const auto read_exposures = std::span(block.exposures).first(block.batch->exposures);
        if (from_zero && !zero_us) {
            zero_us = std::numeric_limits<std::int64_t>::max();
            if (!read_events.empty()) zero_us = read_events.front().t_us;
            if (!read_exposures.empty()) {
                zero_us = std::min(*zero_us, read_exposures.front().t_us);
            }
        }
        if (zero_us) {
            shift(read_events);
            shift(read_exposures);
        }
        const auto held = writer.holds_exposures() ? read_exposures : std::span<Event>{};
        if (auto ok = writer.write(read_events, held); !ok) return ok;
    }
    if (auto ok = writer.close(); !ok) return ok;
    return block.batch ? Result<void>{} : tl::unexpected(block.batch.error());
}

int convert(const ConvertOptions& options) {
    const auto geometry = geometry_of(options.geometry);
    if (!geometry) return report(geometry.error());
    const auto range = sensor::range_of_seconds(options.from_s, options.to_s);
    if (!range) return report(range.error());
    if (auto ok = check_is_not_input(options.to, options.from); !ok) return report(ok.error());
    auto recording = sensor::open_events(options.from, {options.format, *geometry});
    if (!recording) return report(recording.error());
    const auto events = sensor::in_range(std::move(*recording), *range);
    // Before TO is touched. A recording may have no events, but who names a part of it expects some
    // there.
    Block block;
    read_next(*events, block);
    const bool is_whole = range->start_us == 0 && range->end_us == 0;
    if (block.ends() && !is_whole) {
        return report(block.batch
                          ? Error{options.from + ": no event lies in the range of --from and --to"}
                          : block.batch.error());
    }
    auto writer = sensor::create_events(options.to, events->geometry(), events->has_exposures());
    if (!writer) return report(writer.error());
    const auto copied = copy(block, *events, **writer, options.from_zero);
    std::printf("%" PRIu64 " events\n", (*writer)->events_written());
    if ((*writer)->holds_exposures()) {
        std::printf("%" PRIu64 " exposure measurements\n", (*writer)->exposures_written());
    } else if (events->exposures_read() > 0) {
        std::printf("%" PRIu64 " exposure measurements left out: %s cannot hold them\n",
                    events->exposures_read(), options.to.c_str());
    }
    if (events->events_skipped() > 0) {
        std::printf("%" PRIu64 " events of FROM skipped: without time, or of another camera\n",
                    events->events_skipped());
    }
    return copied ? exit_success : report(copied.error());
}

}  // namespace

Run define_convert(CLI::App& app) {
    auto options = std::make_shared<ConvertOptions>();
    app.add_option("FROM", options->from, "Recording of events")->required();
    app.add_option("TO", options->to, "File to write; its extension is its format")->required();
    app.add_option("--format", options->format, format_help());
    app.add_option("--geometry", options->geometry, geometry_help);
    app.add_option("--from", options->from_s, "Begin here, seconds of the recording's time");
    app.add_option("--to", options->to_s, "End before here; 0: to the end");
    app.add_flag("--from-zero", options->from_zero,
                 "Count time from the first event: DAT and Event Stream hold no dates");
    return [options] { return convert(*options); };
}

}  // namespace pursuit::ctl
