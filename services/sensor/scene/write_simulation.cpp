// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/write_simulation.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <filesystem>
#include <utility>
#include <vector>

#include "services/common/atomic_file.hpp"
#include "services/common/output_file.hpp"
#include "services/sensor/scene/scene_simulator.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::int64_t truth_period_us = 1000;
constexpr double longest_s = 86'400;
constexpr std::int64_t slice_us = 10 * truth_period_us;

__attribute__((format(printf, 2, 3))) void print(std::string& out, const char* format, ...) {
    char line[512];
    va_list values;
    va_start(values, format);
    const int length = std::vsnprintf(line, sizeof line, format, values);
    va_end(values);
    out.append(line, static_cast<std::size_t>(std::clamp<int>(length, 0, sizeof line - 1)));
}

std::string points_csv(const ContourModel& model) {
    std::string csv = "x_px,y_px\n";
    for (const Point& p : model.points) print(csv, "%.6f,%.6f\n", p.x(), p.y());
    return csv;
}

std::string edges_csv(const ContourModel& model) {
    std::string csv = "from,to\n";
    for (const auto& [from, to] : model.edges) print(csv, "%u,%u\n", from, to);
    return csv;
}

/// As the tracker calls it.
const char* transform_name(disk::SceneLayer::Transform transform) {
    switch (transform) {
        case disk::SceneLayer::ISOMETRY:
            return "isometry";
        case disk::SceneLayer::SIMILARITY:
            return "similarity";
        case disk::SceneLayer::PAPER_AFFINE:
            return "paper_affine";
        case disk::SceneLayer::FULL_AFFINE:
            return "full_affine";
    }
    return "";
}

std::string start_csv(const std::vector<SceneModel>& models, Geometry geometry) {
    std::string csv =
        "object,x_px,y_px,theta_rad,scale,mode,error_x_px,error_y_px,error_theta_rad,error_scale,"
        "transform\n";
    for (const auto& m : models) {
        const char* transform = transform_name(m.transform);
        if (m.search) {
            print(csv, "%s,%.3f,%.3f,0,1,search,,,,,%s\n", m.name.c_str(), geometry.width / 2.0,
                  geometry.height / 2.0, transform);
        } else {
            print(csv, "%s,%.6f,%.6f,%.8f,%.8f,pose,%.6f,%.6f,%.8f,%.8f,%s\n", m.name.c_str(),
                  m.start.x_px, m.start.y_px, m.start.theta_rad,
                  (m.start.scale_x + m.start.scale_y) / 2, m.error_x_px, m.error_y_px,
                  m.error_theta_rad, m.error_scale, transform);
        }
    }
    return csv;
}

void print_truth(std::string& csv, const TruthRow& row) {
    print(csv, "%lld,%u,%s,%.6f,%.6f,%.9f,%.9f,%.9f,%.9f,%.8f,%.8f,%.8f,%.4f,%.4f\n",
          static_cast<long long>(row.t_us), row.object_id, row.model.c_str(), row.x_px, row.y_px,
          row.a00, row.a01, row.a10, row.a11, row.theta_rad, row.scale_x, row.scale_y,
          row.visible_fraction, row.fit_px);
}

Result<void> write_models_of(const SceneSimulator& simulator, const std::string& folder,
                             const std::vector<std::string>& kept_paths) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return fail(folder + ": cannot be made: " + error.message());
    std::vector<std::pair<std::string, std::string>> files;
    const auto add = [&](const std::string& name, std::string content) {
        files.emplace_back((std::filesystem::path(folder) / name).string(), std::move(content));
    };
    for (const auto& m : simulator.models()) {
        add("model_" + m.name + ".csv", points_csv(m.model));
        add("model_" + m.name + "_edges.csv", edges_csv(m.model));
        if (m.model.points == m.true_model.points) continue;
        add("model_true_" + m.name + ".csv", points_csv(m.true_model));
    }
    add("start.csv", start_csv(simulator.models(), simulator.geometry()));
    for (const auto& [path, content] : files) {
        for (const auto& kept : kept_paths) {
            if (auto ok = check_are_two_outputs(kept, path); !ok) return ok;
        }
    }
    for (const auto& [path, content] : files) {
        if (auto ok = write_file_atomically(path, content); !ok) return ok;
    }
    return {};
}

}  // namespace

Result<void> write_models(const Scene& scene, std::uint64_t seed, const std::string& models_dir) {
    return write_models_of(SceneSimulator(scene, seed), models_dir, {});
}

Result<SimulationSummary> write_simulation(const Scene& scene, std::uint64_t seed,
                                           const EventSink& events, const SimulationFiles& files) {
    SceneSimulator simulator(scene, seed);
    SimulationSummary summary;
    if (files.duration_s) {
        if (!(*files.duration_s > 0 && *files.duration_s <= longest_s)) {
            return fail("duration: not more than 0 and at most 86400 s");
        }
        summary.duration_us = static_cast<std::int64_t>(*files.duration_s * 1e6);
    } else if (simulator.duration_us()) {
        summary.duration_us = *simulator.duration_us();
    } else {
        return fail(scene.description().name() + ": never ends: state a duration");
    }
    auto truth = OutputFile::create(files.truth_path);
    if (!truth) return tl::unexpected(truth.error());
    if (files.models_dir) {
        auto kept_paths = files.kept_paths;
        kept_paths.push_back(files.truth_path);
        if (auto ok = write_models_of(simulator, *files.models_dir, kept_paths); !ok) {
            return tl::unexpected(ok.error());
        }
    }

    std::string csv =
        "t_us,object_id,model,x_px,y_px,a00,a01,a10,a11,theta_rad,scale_x,scale_y,"
        "visible_fraction,fit_px\n";
    std::vector<Event> slice;
    std::vector<Event> exposures;
    std::int64_t truth_us = 0;
    for (;;) {
        for (; truth_us <= std::min(simulator.time_us(), summary.duration_us);
             truth_us += truth_period_us) {
            for (const auto& row : simulator.truth(truth_us)) print_truth(csv, row);
        }
        if (auto ok = truth->write(csv); !ok) return tl::unexpected(ok.error());
        csv.clear();
        const std::int64_t left_us = summary.duration_us - simulator.time_us();
        slice.clear();
        exposures.clear();
        if (left_us <= 0 || !simulator.next(std::min(slice_us, left_us), slice, &exposures)) break;
        if (auto ok = events(slice, exposures); !ok) return tl::unexpected(ok.error());
        summary.events += slice.size();
    }
    if (auto ok = truth->close(); !ok) return tl::unexpected(ok.error());
    summary.duration_us = simulator.time_us();
    return summary;
}

}  // namespace pursuit::sensor
