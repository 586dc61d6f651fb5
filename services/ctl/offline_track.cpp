// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/offline_track.hpp"

#include <chrono>
#include <utility>

#include "services/common/output_file.hpp"
#include "services/ctl/pose_csv.hpp"
#include "services/sensor/formats/formats.hpp"
#include "services/tracker/model_file.hpp"
#include "services/tracker/start_settings.hpp"

namespace pursuit::ctl {
namespace {

constexpr std::size_t block_events = 4096;

/// Writes every pose; keeps the first error.
class TableSink final : public tracker::PoseSink {
 public:
    explicit TableSink(PoseCsvWriter& table) : table_(table) {}

    void pose(const tracker::PoseRecord& record) override {
        if (auto written = table_.write(row_of(record)); !written && ok) ok = written;
    }

    Result<void> ok;

 private:
    PoseCsvWriter& table_;
};

/// The table of poses must be none of the files that are read.
Result<void> check_inputs(const OfflineTrack& task, const disk::TrackerConfig& config) {
    std::vector<std::string> inputs = {task.events, task.config_path};
    for (const auto& argument : config.model()) {
        const auto model = tracker::parse_model_argument(argument);
        if (!model) continue;  // Told with the field that it is in, by who reads it.
        for (auto& path : tracker::model_file_paths(model->path)) inputs.push_back(std::move(path));
    }
    for (const auto& input : inputs) {
        if (auto ok = check_is_not_input(task.poses, input); !ok) return ok;
    }
    return {};
}

Result<void> register_models(const OfflineTrack& task, const disk::TrackerConfig& config,
                             tracker::Tracker& tracker) {
    if (config.model().empty()) return fail("no model is named");
    auto registrations = tracker::configured_models(config);
    if (!registrations) return tl::unexpected(registrations.error());
    for (auto& registration : *registrations) {
        registration.transform = task.transform.value_or(registration.transform);
        registration.estimator = task.estimator.value_or(registration.estimator);
        if (const auto id = tracker.register_object(registration); !id) {
            return fail("model " + registration.shape.name + ": " + id.error().message);
        }
    }
    return {};
}

/// Everything from the first event to the recording's end or its error.
Result<void> follow(sensor::EventReader& events, tracker::Tracker& tracker, TableSink& sink) {
    std::vector<Event> block(block_events);
    for (;;) {
        const auto count = events.read(block);
        if (!count || *count == 0) {
            // As the end of a live stream: no event before the microsecond after the last.
            if (tracker.last_t_us() >= 0) tracker.advance(tracker.last_t_us() + 1, sink);
            return count ? Result<void>{} : tl::unexpected(count.error());
        }
        tracker.process(std::span(block).first(*count), sink);
        if (!sink.ok) return sink.ok;
    }
}

}  // namespace

Result<OfflineTrackSummary> track_offline(const OfflineTrack& task) {
    auto config = task.config;
    for (const auto& model : task.models) config.add_model(model);
    if (auto ok = check_inputs(task, config); !ok) return tl::unexpected(ok.error());
    auto tracker = tracker::configured_tracker(task.config, 1);
    if (!tracker) return tl::unexpected(tracker.error());
    sensor::ReadOptions options;
    options.geometry = task.geometry;
    auto recording = sensor::open_events(task.events, options);
    if (!recording) return tl::unexpected(recording.error());
    const auto events = sensor::in_range(std::move(*recording), task.range);
    if (const Geometry geometry = events->geometry(); !tracker::is_usable(geometry)) {
        return fail(task.events + ": an image of " + std::to_string(geometry.width) + "x" +
                    std::to_string(geometry.height) + ": the tracker takes 1 to " +
                    std::to_string(tracker::max_pixels) + " pixels");
    }
    // Objects are registered before the stream begins, as the service does with those of its
    // configuration.
    if (auto ok = register_models(task, config, *tracker); !ok) return tl::unexpected(ok.error());
    tracker->begin_stream(events->geometry(), 1);

    auto table = PoseCsvWriter::create(task.poses);
    if (!table) return tl::unexpected(table.error());
    TableSink sink(*table);
    const auto start = std::chrono::steady_clock::now();
    const auto followed = follow(*events, *tracker, sink);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    if (!sink.ok) return tl::unexpected(sink.ok.error());
    if (auto ok = table->close(); !ok) return tl::unexpected(ok.error());
    if (!followed) return tl::unexpected(followed.error());
    return OfflineTrackSummary{tracker->counters(), tracker->snapshots(), wall.count()};
}

}  // namespace pursuit::ctl
