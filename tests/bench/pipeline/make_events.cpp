// SPDX-License-Identifier: Apache-2.0
// A stream of a given rate for the pipeline benchmark: two outlines that move and turn, every fifth
// event on one of them, the others noise all over the image.
//
//   make_events RATE_HZ SECONDS FOLDER
//
// writes FOLDER/events.dat, left.model.textproto, right.model.textproto and truth.csv (where each
// is every ms), and prints "MODEL@x,y,theta" of each.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "services/sensor/formats/dat_writer.hpp"
#include "services/tracker/model_file.hpp"

namespace pursuit {
namespace {

constexpr Geometry geometry{1280, 720};
constexpr double share_on_objects = 0.2;
constexpr int points = 200;

struct Object {
    const char* name;
    double x_px, y_px;  // about which it moves
    int lobes;
    double sense;  // of its motion
};
constexpr std::array<Object, 2> objects{{{"left", 380, 360, 3, 1}, {"right", 900, 360, 5, -1}}};

/// About 240 px across, without symmetry.
tracker::Shape shape_of(const Object& object) {
    tracker::Shape shape{object.name, {}, {}};
    for (int i = 0; i < points; ++i) {
        const double angle = 2 * std::numbers::pi * i / points;
        const double radius = 110 + 12 * std::cos(object.lobes * angle) + 8 * std::sin(2 * angle);
        shape.points_px.push_back(
            (radius * Eigen::Vector2d(std::cos(angle), std::sin(angle))).cast<float>());
        shape.edges.push_back(
            {static_cast<std::uint16_t>(i), static_cast<std::uint16_t>((i + 1) % points)});
    }
    return tracker::centred(shape);
}

/// Where an object is, and its velocity: on an ellipse at 250 to 500 px/s, swinging by 0.2 rad.
struct Motion {
    tracker::Pose pose;
    Eigen::Vector2d velocity_px_s;
    double omega_rad_s;
    double theta_rad;
};

Motion motion_of(const Object& object, double t_s) {
    const double phase = 2 * std::numbers::pi * 2 * t_s * object.sense;
    const double rate = 2 * std::numbers::pi * 2 * object.sense;
    const double theta = 0.2 * std::sin(phase / 2);
    return {tracker::pose_of(object.x_px + 40 * std::cos(phase), object.y_px + 20 * std::sin(phase),
                             theta),
            {-40 * rate * std::sin(phase), 20 * rate * std::cos(phase)},
            0.1 * rate * std::cos(phase / 2),
            theta};
}

class Scene {
 public:
    Scene() {
        for (const Object& object : objects) shapes_.push_back(shape_of(object));
    }

    const std::vector<tracker::Shape>& shapes() const { return shapes_; }

    void at(double t_s) {
        for (std::size_t k = 0; k < objects.size(); ++k) motions_[k] = motion_of(objects[k], t_s);
    }

    /// Between independent events, in units of its mean.
    double waiting() { return -std::log(1 - uniform()); }

    Event event(std::int64_t t_us) {
        if (uniform() < share_on_objects) return on_contour(t_us);
        return {t_us, static_cast<std::uint16_t>(uniform() * geometry.width),
                static_cast<std::uint16_t>(uniform() * geometry.height),
                static_cast<std::uint8_t>(random_() & 1)};
    }

 private:
    /// Where an edge moves across itself there are events, the more the faster it does; inside is
    /// dark.
    Event on_contour(std::int64_t t_us) {
        for (;;) {
            const std::size_t k = random_() % objects.size();
            const Motion& motion = motions_[k];
            const auto& edge = shapes_[k].edges[random_() % shapes_[k].edges.size()];
            const auto a = shapes_[k].points_px[edge.from].cast<double>();
            const auto b = shapes_[k].points_px[edge.to].cast<double>();
            const Eigen::Vector2d arm = motion.pose.a * (a + (b - a) * uniform());
            const Eigen::Vector2d along = motion.pose.a * (b - a);
            const auto outward = Eigen::Vector2d(along.y(), -along.x()).normalized();
            const Eigen::Vector2d velocity =
                motion.velocity_px_s + motion.omega_rad_s * Eigen::Vector2d(-arm.y(), arm.x());
            const double across_px_s = outward.dot(velocity);
            if (uniform() * 600 > std::abs(across_px_s)) continue;
            const Eigen::Vector2d p = motion.pose.t_px + arm;
            return {t_us, static_cast<std::uint16_t>(std::lround(p.x())),
                    static_cast<std::uint16_t>(std::lround(p.y())),
                    static_cast<std::uint8_t>(across_px_s < 0)};
        }
    }

    double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

    std::vector<tracker::Shape> shapes_;
    std::array<Motion, objects.size()> motions_{};
    std::mt19937_64 random_{1};
};

Result<void> write_events(Scene& scene, double rate_hz, double seconds, const std::string& path) {
    auto writer = sensor::create_dat(path, geometry);
    if (!writer) return tl::unexpected(writer.error());
    std::vector<Event> events;
    std::int64_t last_us = -1;
    const auto count = static_cast<std::int64_t>(rate_hz * seconds);
    double t_s = 0;
    for (std::int64_t i = 0; i < count; ++i) {
        // Each independent of the others: packets then begin at any time between two poses.
        t_s += scene.waiting() / rate_hz;
        const auto t_us = static_cast<std::int64_t>(t_s * 1e6);
        if (t_us != last_us) scene.at(t_s);
        last_us = t_us;
        events.push_back(scene.event(t_us));
        if (events.size() < 65'536 && i + 1 < count) continue;
        if (auto ok = (*writer)->write(events); !ok) return ok;
        events.clear();
    }
    return (*writer)->close();
}

bool write_truth(double seconds, const std::string& path) {
    std::FILE* file = std::fopen(path.c_str(), "we");
    if (file == nullptr) return false;
    std::fprintf(file, "t_us,model,x_px,y_px,theta_rad\n");
    for (int ms = 0; ms < seconds * 1e3; ++ms) {
        for (const Object& object : objects) {
            const Motion motion = motion_of(object, ms * 1e-3);
            std::fprintf(file, "%d000,%s,%.6f,%.6f,%.8f\n", ms, object.name, motion.pose.t_px.x(),
                         motion.pose.t_px.y(), motion.theta_rad);
        }
    }
    const bool good = std::ferror(file) == 0;
    return std::fclose(file) == 0 && good;
}

int run(double rate_hz, double seconds, const std::string& folder) {
    Scene scene;
    const auto failed = [](const std::string& message) {
        std::fprintf(stderr, "make_events: %s\n", message.c_str());
        return 1;
    };
    for (std::size_t k = 0; k < objects.size(); ++k) {
        const std::string path = folder + "/" + objects[k].name + ".model.textproto";
        const auto written = tracker::write_model_file(path, {scene.shapes()[k], {}, {}});
        if (!written) return failed(written.error().message);
        const Motion start = motion_of(objects[k], 0);
        std::printf("%s@%.6f,%.6f,%.8f\n", path.c_str(), start.pose.t_px.x(), start.pose.t_px.y(),
                    start.theta_rad);
    }
    if (!write_truth(seconds, folder + "/truth.csv")) return failed("cannot write truth.csv");
    const auto written = write_events(scene, rate_hz, seconds, folder + "/events.dat");
    return written ? 0 : failed(written.error().message);
}

}  // namespace
}  // namespace pursuit

int main(int argc, char** argv) {
    const double rate_hz = argc == 4 ? std::atof(argv[1]) : 0;
    const double seconds = argc == 4 ? std::atof(argv[2]) : 0;
    if (!(rate_hz >= 1e3 && rate_hz <= 1e9 && seconds > 0 && seconds <= 3600)) {
        std::fprintf(stderr, "make_events RATE_HZ SECONDS FOLDER\n");
        return 2;
    }
    return pursuit::run(rate_hz, seconds, argv[3]);
}
