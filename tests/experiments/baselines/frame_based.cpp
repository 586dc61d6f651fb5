// SPDX-License-Identifier: Apache-2.0
// What the paper compares itself with: events accumulated into frames, and each frame registered
// to the model from where the one before left it.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
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
    double grey_change = 0;
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

/// The pixels whose grey level differs from the frame before: what a frame camera of this rate
/// would see change. Grey levels come from exposure measurements; a pixel's first one is no change.
class GreyFrame {
 public:
    /// `change`: least difference of ln(grey).
    GreyFrame(Geometry geometry, double change)
        : width_(geometry.width),
          change_(change),
          begun_us_(std::size_t{geometry.width} * geometry.height, -1),
          grey_(begun_us_.size(), 0),
          before_(begun_us_.size(), 0) {}

    void add(const Event& crossing) {
        const auto index = std::size_t{crossing.y} * width_ + crossing.x;
        if (crossing.polarity == 0) {
            begun_us_[index] = crossing.t_us;
        } else if (begun_us_[index] >= 0 && crossing.t_us > begun_us_[index]) {
            grey_[index] = -std::log(static_cast<double>(crossing.t_us - begun_us_[index]));
            begun_us_[index] = -1;
            if (before_[index] == 0) before_[index] = grey_[index];
            measured_.push_back(index);
        }
    }

    /// Ends the frame.
    Points take() {
        Points points;
        for (const auto index : measured_) {
            if (std::abs(grey_[index] - before_[index]) > change_) {
                points.emplace_back(index % width_, index / width_);
            }
            before_[index] = grey_[index];
        }
        measured_.clear();
        return points;
    }

 private:
    std::size_t width_;
    double change_;
    std::vector<std::int64_t> begun_us_;
    std::vector<double> grey_;    // ln; 0: not yet measured
    std::vector<double> before_;  // at the end of the frame before
    std::vector<std::size_t> measured_;
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

/// Frames, from the events and exposure measurements of a recording.
class Tracking {
 public:
    Tracking(const Options& options, std::vector<Object>& objects, Geometry geometry)
        : options_(options),
          objects_(objects),
          frame_(geometry),
          grey_(geometry, options.grey_change),
          end_us_(options.window_us) {
        for (const auto& object : objects_) write_row(csv, 0, object);
    }

    void add_event(const Event& event) {
        end_frames(event.t_us);
        frame_.add(event);
    }

    void add_exposure(const Event& crossing) {
        end_frames(crossing.t_us);
        grey_.add(crossing);
    }

    std::uint64_t frames() const { return frames_; }

    std::string csv = "t_us,model,x_px,y_px,a00,a01,a10,a11\n";  ///< Rows not yet written.

 private:
    void end_frames(std::int64_t t_us) {
        for (; t_us >= end_us_; end_us_ += options_.window_us) {
            const Points points = options_.grey_change > 0 ? grey_.take() : frame_.points();
            for (auto& object : objects_) {
                object.pose = registered(object.model, points, object.pose, options_.registration);
                write_row(csv, end_us_, object);
            }
            frame_.clear();
            ++frames_;
        }
    }

    const Options& options_;
    std::vector<Object>& objects_;
    Frame frame_;
    GreyFrame grey_;
    std::int64_t end_us_;
    std::uint64_t frames_ = 0;
};

Result<std::uint64_t> track(const Options& options, std::vector<Object>& objects,
                            std::ofstream& out) {
    auto recording = sensor::open_events(options.events);
    if (!recording) return tl::unexpected(recording.error());
    if (options.grey_change > 0 && !(*recording)->has_exposures()) {
        return fail(options.events + ": holds no exposure measurements");
    }
    Tracking tracking(options, objects, (*recording)->geometry());
    std::vector<Event> events(4096);
    std::vector<Event> exposures(4096);
    for (;;) {
        const auto batch = (*recording)->read(events, exposures);
        if (!batch) return tl::unexpected(batch.error());
        if (batch->at_end) return tracking.frames();
        std::size_t e = 0;
        std::size_t x = 0;
        while (e < batch->events || x < batch->exposures) {
            if (x == batch->exposures ||
                (e < batch->events && events[e].t_us <= exposures[x].t_us)) {
                tracking.add_event(events[e++]);
            } else {
                tracking.add_exposure(exposures[x++]);
            }
        }
        out << tracking.csv;
        tracking.csv.clear();
    }
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
    app.add_option("--grey-change", options.grey_change,
                   "Frames of pixels whose ln(grey) changed by this, from exposure measurements; "
                   "0: of events")
        ->check(CLI::NonNegativeNumber);
    app.add_option("--gate", registration.gate_px, "Farther pixels are left out, px; 0: none")
        ->check(CLI::NonNegativeNumber);
    app.add_option("--least-points", registration.least_points, "With fewer the pose stays");
    app.add_option("--share", registration.share, "How much of the way to the fit the pose goes")
        ->check(CLI::Range(0.0, 1.0));
    CLI11_PARSE(app, argc, argv);
    return pursuit::experiments::run(options);
}
