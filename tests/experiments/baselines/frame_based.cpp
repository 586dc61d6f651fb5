// SPDX-License-Identifier: Apache-2.0
// What the paper compares itself with: events accumulated into frames, and each frame registered
// to the model from where the one before left it.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>

#include "services/common/csv.hpp"
#include "services/sensor/formats/formats.hpp"
#include "services/tracker/core/kinds.hpp"
#include "services/tracker/model_file.hpp"
#include "tests/experiments/baselines/registration.hpp"

namespace pursuit::experiments {
namespace {

struct Options {
    std::string events;
    std::string poses;
    std::vector<std::string> models;
    std::string method = "icp";
    std::string transform = "isometry";
    std::int64_t window_us = 200;
    RegistrationSettings registration;
};

struct Object {
    std::string name;
    Points model;
    tracker::Pose pose;
};

/// The pixels that fired in a window, each once.
class Frame {
 public:
    explicit Frame(Geometry geometry)
        : width_(geometry.width), seen_(std::size_t{geometry.width} * geometry.height, 0) {}

    void add(const Event& event) {
        auto& seen = seen_[std::size_t{event.y} * width_ + event.x];
        if (seen == number_) return;
        seen = number_;
        points_.emplace_back(event.x, event.y);
    }

    const Points& points() const { return points_; }

    void clear() {
        ++number_;
        points_.clear();
    }

 private:
    std::size_t width_;
    std::uint64_t number_ = 1;
    std::vector<std::uint64_t> seen_;
    Points points_;
};

void write_row(std::string& csv, std::int64_t t_us, const Object& object) {
    csv += std::to_string(t_us) + "," + object.name;
    for (const double value : {object.pose.t_px.x(), object.pose.t_px.y(), object.pose.a(0, 0),
                               object.pose.a(0, 1), object.pose.a(1, 0), object.pose.a(1, 1)}) {
        csv += ',';
        append_number(csv, value);
    }
    csv += '\n';
}

Result<std::vector<Object>> read_objects(const Options& options) {
    std::vector<Object> objects;
    for (const auto& argument : options.models) {
        const auto parsed = tracker::parse_model_argument(argument);
        if (!parsed) return tl::unexpected(parsed.error());
        if (!parsed->start) return fail(argument + ": a frame-based method needs a start pose");
        const auto file = tracker::read_model_file(parsed->path);
        if (!file) return tl::unexpected(file.error());
        Object object{file->shape.name, {}, *parsed->start};
        for (const auto& p : file->shape.points_px) object.model.push_back(p.cast<double>());
        objects.push_back(std::move(object));
    }
    return objects;
}

Result<std::uint64_t> track(const Options& options, std::vector<Object>& objects,
                            std::ofstream& out) {
    auto recording = sensor::open_events(options.events);
    if (!recording) return tl::unexpected(recording.error());
    Frame frame((*recording)->geometry());
    std::string csv = "t_us,model,x_px,y_px,a00,a01,a10,a11\n";
    for (const auto& object : objects) write_row(csv, 0, object);
    std::uint64_t frames = 0;
    std::int64_t end_us = options.window_us;
    std::vector<Event> block(4096);
    for (;;) {
        const auto count = (*recording)->read(block);
        if (!count) return tl::unexpected(count.error());
        if (*count == 0) break;
        for (std::size_t i = 0; i < *count; ++i) {
            while (block[i].t_us >= end_us) {
                for (auto& object : objects) {
                    object.pose =
                        registered(object.model, frame.points(), object.pose, options.registration);
                    write_row(csv, end_us, object);
                }
                frame.clear();
                ++frames;
                end_us += options.window_us;
            }
            frame.add(block[i]);
        }
        out << csv;
        csv.clear();
    }
    return frames;
}

int run(Options& options) {
    const auto refuse = [](const std::string& message) {
        std::fprintf(stderr, "frame_based: %s\n", message.c_str());
        return 1;
    };
    const auto transform = tracker::parse_transform(options.transform);
    if (!transform) return refuse("--transform: must be " + tracker::transform_names());
    options.registration.transform = *transform;
    options.registration.iterations = options.method == "icp" ? 20 : 1;
    auto objects = read_objects(options);
    if (!objects) return refuse(objects.error().message);
    std::ofstream out(options.poses, std::ios::binary | std::ios::trunc);
    const auto begin = std::chrono::steady_clock::now();
    const auto frames = track(options, *objects, out);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    if (!frames) return refuse(frames.error().message);
    out.close();
    if (!out) return refuse(options.poses + ": cannot be written");
    std::fprintf(stderr, "%llu frames in %.2f s\n", static_cast<unsigned long long>(*frames),
                 wall.count());
    return 0;
}

}  // namespace
}  // namespace pursuit::experiments

int main(int argc, char** argv) {
    CLI::App app("Registers frames of accumulated events to a model");
    pursuit::experiments::Options options;
    auto& registration = options.registration;
    app.add_option("--events", options.events, "Recording of events")->required();
    app.add_option("--poses", options.poses, "Table of poses to write, CSV")->required();
    app.add_option("--model", options.models, "PATH@x,y,theta[,scale]; once an object")->required();
    app.add_option("--method", options.method, "procrustes: one fit a frame; icp: until it rests")
        ->check(CLI::IsMember({"procrustes", "icp"}));
    app.add_option("--transform", options.transform, "As pursuitctl track");
    app.add_option("--window-us", options.window_us, "Length of a frame")
        ->check(CLI::Range(1, 1'000'000));
    app.add_option("--gate", registration.gate_px, "Farther pixels are left out, px; 0: none")
        ->check(CLI::NonNegativeNumber);
    app.add_option("--least-points", registration.least_points, "With fewer the pose stays");
    app.add_option("--share", registration.share, "How much of the way to the fit the pose goes")
        ->check(CLI::Range(0.0, 1.0));
    CLI11_PARSE(app, argc, argv);
    return pursuit::experiments::run(options);
}
