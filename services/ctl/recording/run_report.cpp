// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/recording/run_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "services/ctl/evaluation/evaluate.hpp"
#include "services/ctl/evaluation/interpolation.hpp"
#include "services/ctl/evaluation/pairs.hpp"
#include "services/ctl/evaluation/point_error.hpp"

namespace pursuit::ctl {
namespace {

constexpr const char* state_names[] = {"SEARCHING", "TRACKING", "OCCLUDED", "LOST"};

ReportPose::State report_state(v1::TrackState state) {
    switch (state) {
        case v1::TRACK_SEARCHING:
            return ReportPose::State::searching;
        case v1::TRACK_TRACKING:
            return ReportPose::State::tracking;
        case v1::TRACK_OCCLUDED:
            return ReportPose::State::occluded;
        case v1::TRACK_LOST:
            break;
    }
    return ReportPose::State::lost;
}

std::string name_of(const RecordedRun& run, std::uint32_t id) {
    const auto model = run.models.find(id);
    return model == run.models.end() ? "object " + std::to_string(id)
                                     : model->second.name().to_string();
}

ModelPoints model_points(const v1::RegisteredModel& model) {
    ModelPoints points;
    for (const auto& point : model.points()) points.emplace_back(point.x_px(), point.y_px());
    return points;
}

/// When the recording ends, in the stream's time.
double end_us(const RecordedRun& run) {
    std::optional<std::int64_t> last_us = run.last_t_us;
    for (const auto& [id, poses] : run.poses) {
        if (!poses.empty())
            last_us = std::max(last_us.value_or(poses.back().t_us), poses.back().t_us);
    }
    return static_cast<double>(last_us.value_or(0));
}

/// The truth of an object as far as the recording goes; nothing where there is none.
std::optional<ObjectRows> truth_of(const std::vector<ObjectRows>& truth, const RecordedRun& run,
                                   const std::string& name) {
    const auto found = std::find_if(truth.begin(), truth.end(),
                                    [&](const auto& rows) { return rows.model == name; });
    if (found == truth.end()) return std::nullopt;
    ObjectRows rows = *found;
    const auto count = count_up_to(rows.t_us, end_us(run));
    rows.t_us.resize(count);
    rows.pose.resize(count);
    rows.state.resize(count);
    rows.confidence.resize(count);
    rows.visible.resize(count);
    return count < 2 ? std::nullopt : std::optional(std::move(rows));
}

/// Error over time, and the score, of one object.
void score_object(ReportObject& object, const ObjectRows& rows, const ObjectRows& truth,
                  const ModelPoints& points) {
    for (std::size_t i = 0; i < truth.t_us.size(); ++i) {
        const auto& p = truth.pose[i];
        object.truth.push_back({static_cast<std::int64_t>(truth.t_us[i]), p[0], p[1], p[2], p[3],
                                p[4], p[5], ReportPose::State::tracking});
    }
    const auto pairs = pair_up(started_rows(rows), truth, {});
    const PointError error_px(points);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        object.error_px.push_back({static_cast<std::int64_t>(pairs.t_us[i]),
                                   error_px(pairs.pose[i], pairs.reference[i])});
    }
    const auto scores = evaluate({rows}, {truth}, {{truth.model, points}}, nullptr, {});
    if (!scores || scores->empty()) return;
    const auto& score = scores->front();
    object.mean_error_px = score.error;
    object.lost = score.lost;
    if (score.lies) {
        object.lies = static_cast<std::uint64_t>(
            std::llround(*score.lies * static_cast<double>(pairs.size())));
    }
}

ReportObject make_object(const RecordedRun& run, std::uint32_t id, const ObjectRows& rows,
                         const std::vector<ObjectRows>& truth) {
    ReportObject object;
    object.name = rows.model;
    object.id = id;
    for (const auto& pose : run.poses.at(id)) {
        object.poses.push_back({pose.t_us, pose.x_px, pose.y_px, pose.a00, pose.a01, pose.a10,
                                pose.a11, report_state(pose.state)});
    }
    const auto model = run.models.find(id);
    if (model == run.models.end()) return object;
    const auto points = model_points(model->second);
    for (const auto& point : points) object.points_px.emplace_back(point.x(), point.y());
    for (const auto& edge : model->second.edges()) {
        object.edges.emplace_back(edge.from_point(), edge.to_point());
    }
    if (const auto rows_of_truth = truth_of(truth, run, rows.model)) {
        score_object(object, rows, *rows_of_truth, points);
    }
    return object;
}

void add_counts(Report& report, const RecordedRun& run) {
    auto& counts = report.counts;
    counts.push_back({"events recorded", run.events, false});
    counts.push_back({"packets recorded", run.packets, false});
    counts.push_back({"packets missing in the recording", run.packets_missing, true});
    counts.push_back({"poses missing in the recording", run.poses_missing, true});
    counts.push_back({"calls missing in the recording", run.calls_missing, true});
    counts.push_back({"faults in the recording", run.faults.size(), true});
    if (run.sensor) {
        counts.push_back({"sensor: events published", run.sensor->events_out(), false});
        counts.push_back({"sensor: events dropped", run.sensor->events_dropped(), true});
    }
    if (run.tracker) {
        counts.push_back({"tracker: events received", run.tracker->events_in(), false});
        counts.push_back({"tracker: events used", run.tracker->events_used(), false});
        counts.push_back({"tracker: packets missed", run.tracker->packets_missed(), true});
        counts.push_back({"tracker: events dropped", run.tracker->events_dropped(), true});
        counts.push_back({"tracker: poses published", run.tracker->poses_out(), false});
        for (const auto& cause : run.tracker->dropped_by()) {
            if (cause.count() == 0) continue;
            const std::string name = cause.name().to_string();
            // Objects that are not followed any more are no lost data.
            const bool is_of_objects = name.rfind("objects.", 0) == 0;
            counts.push_back({is_of_objects ? "tracker: " + name : "tracker: dropped by " + name,
                              cause.count(), !is_of_objects});
        }
    }
    if (run.recorder) {
        counts.push_back({"recorder: messages dropped", run.recorder->messages_dropped(), true});
    }
}

void add_rates(Report& report, const RecordedRun& run) {
    ReportCurve curve{"events", "events/s", {}};
    for (const auto& [begin_us, count] : run.events_per_bin) {
        curve.samples.push_back({begin_us + RecordedRun::bin_us / 2,
                                 static_cast<double>(count) * 1e6 / RecordedRun::bin_us});
    }
    report.curves.push_back(std::move(curve));
    if (!run.tracker) return;
    const auto& latency = run.tracker->latency();
    report.latencies.push_back({"packet's pacing instant to its poses, last 10 s", latency.p50_us(),
                                latency.p90_us(), latency.p99_us(), latency.max_us(),
                                latency.samples()});
}

void add_facts(Report& report, const RecordedRun& run) {
    const auto health = [&](const char* service, const v1::ServiceHealth& facts) {
        report.facts.emplace_back(std::string(service) + " version", facts.version().to_string());
        report.facts.emplace_back(std::string(service) + " configuration",
                                  facts.configuration_digest().to_string());
        if (facts.errors() > 0) {
            report.facts.emplace_back(std::string(service) + " last error",
                                      facts.last_error().to_string());
        }
    };
    if (run.sensor) {
        report.facts.emplace_back("source", run.sensor->source().to_string());
        health("sensor", run.sensor->health());
    }
    if (run.tracker) {
        health("tracker", run.tracker->health());
        char busy[32];
        std::snprintf(busy, sizeof busy, "%.1f %%", 100 * run.tracker->busy_fraction());
        report.facts.emplace_back("tracker busy, of event time", busy);
    }
    if (run.recorder) health("recorder", run.recorder->health());
    for (const auto& [effective_us, name] : run.strategies) {
        report.facts.emplace_back("strategy from " + std::to_string(effective_us) + " us", name);
    }
    for (const auto& fault : run.faults) report.facts.emplace_back("recording", fault);
}

}  // namespace

std::vector<ObjectRows> object_rows(const RecordedRun& run) {
    std::vector<ObjectRows> all;
    for (const auto& [id, poses] : run.poses) {
        ObjectRows rows;
        rows.model = name_of(run, id);
        rows.object_id = std::to_string(id);
        for (const auto& pose : poses) {
            rows.t_us.push_back(static_cast<double>(pose.t_us));
            rows.pose.push_back({pose.x_px, pose.y_px, pose.a00, pose.a01, pose.a10, pose.a11});
            rows.state.emplace_back(state_names[pose.state]);
            rows.confidence.push_back(pose.confidence);
            rows.visible.push_back(1);
        }
        all.push_back(std::move(rows));
    }
    return all;
}

Report make_report(const RecordedRun& run, const std::vector<ObjectRows>& truth,
                   const std::string& title) {
    Report report;
    report.title = title;
    char subtitle[160];
    std::snprintf(subtitle, sizeof subtitle, "%.2f s, %llu events, %zu object(s), %d × %d px",
                  run.first_t_us ? static_cast<double>(*run.last_t_us - *run.first_t_us) * 1e-6 : 0,
                  static_cast<unsigned long long>(run.events), run.poses.size(),
                  int{run.geometry.width}, int{run.geometry.height});
    report.subtitle = subtitle;
    report.geometry = run.geometry;
    const auto rows = object_rows(run);
    std::size_t index = 0;
    for (const auto& [id, poses] : run.poses) {
        report.objects.push_back(make_object(run, id, rows[index++], truth));
    }
    for (const auto& slice : run.slices) {
        report.slices.push_back({slice.begin_us, slice.end_us, slice.events});
    }
    add_rates(report, run);
    add_counts(report, run);
    add_facts(report, run);
    return report;
}

}  // namespace pursuit::ctl
