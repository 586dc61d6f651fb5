// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/drawn_scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/sensor/scene/random.hpp"
#include "services/sensor/scene/shapes.hpp"

namespace pursuit::sensor {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

/// Streams of the seed; layer i draws from first_layer_stream + i.
constexpr std::uint64_t sensor_stream = 1;
constexpr std::uint64_t camera_stream = 2;
constexpr std::uint64_t first_layer_stream = 1000;

/// For how long an endless scene's random walks are drawn before they repeat.
constexpr double endless_walk_s = 600;

double draw(const disk::Interval& interval, Random& random) {
    return random.uniform(interval.low(), interval.high());
}

/// Settings that real cameras differ in, where the scene does not state them. Each is drawn in any
/// case, so that stating one does not change the others.
void vary(disk::SceneSensor& sensor, Random& random) {
    const double threshold = random.uniform(0.2, 0.42);
    const double mismatch = random.uniform(0.02, 0.06);
    const auto refractory_us = static_cast<std::uint32_t>(random.uniform(500, 1300));
    const double jitter_us = random.uniform(10, 60);
    if (!sensor.has_threshold()) sensor.set_threshold(threshold);
    if (!sensor.has_mismatch()) sensor.set_mismatch(mismatch);
    if (!sensor.has_refractory_us()) sensor.set_refractory_us(refractory_us);
    if (!sensor.has_jitter_us()) sensor.set_jitter_us(jitter_us);
    sensor.set_noise_hz(sensor.noise_hz() * random.uniform(0.8, 1.2));
}

/// Returns how much larger the shape itself is drawn.
double vary(disk::SceneTrajectory& t, const disk::SceneVariation& variation, Random& random) {
    t.set_x_px(t.x_px() + variation.position_px() * random.uniform(-1, 1));
    t.set_y_px(t.y_px() + variation.position_px() * random.uniform(-1, 1));
    t.set_theta_rad(t.theta_rad() + variation.angle_rad() * random.uniform(-1, 1));
    const double size = random.uniform(-1, 1);
    t.set_scale(t.scale() * (1 + variation.scale_share() * size));

    const double speed = 1 + variation.speed_share() * random.uniform(-1, 1);
    const double turn = variation.direction() && random.chance(0.5) ? -speed : speed;
    t.set_vx_px_s(t.vx_px_s() * speed);
    t.set_vy_px_s(t.vy_px_s() * speed);
    t.set_omega_rad_s(t.omega_rad_s() * turn);
    for (auto& sine : *t.mutable_sine()) {
        sine.set_frequency_hz(sine.frequency_hz() * speed);
        if (variation.phase()) sine.set_phase_rad(sine.phase_rad() + random.uniform(0, two_pi));
    }
    if (t.has_disc()) {
        auto& disc = *t.mutable_disc();
        disc.set_rpm(disc.rpm() * turn);
        if (variation.phase()) disc.set_phase_rad(disc.phase_rad() + random.uniform(0, two_pi));
    }
    if (t.has_wander()) t.mutable_wander()->set_speed_px_s(t.wander().speed_px_s() * speed);
    return 1 + variation.size_share() * size;
}

/// A convex polygon: corners on an ellipse at uneven angles.
PaintedPolygon clutter_polygon(const disk::SceneClutter& clutter, Random& random) {
    const Point centre(draw(clutter.x_px(), random), draw(clutter.y_px(), random));
    const double size = draw(clutter.size_px(), random) / 2;
    const double aspect = random.uniform(0.3, 1);
    const Eigen::Rotation2Dd turn(random.uniform(0, two_pi));
    const auto corners = 3 + random.index(5);
    PaintedPolygon polygon;
    polygon.contour = false;
    polygon.reflectance = clutter.has_reflectance() ? draw(clutter.reflectance(), random)
                                                    : random.uniform(0.05, 0.95);
    for (std::uint32_t i = 0; i < corners; ++i) {
        const double angle = two_pi * (i + random.uniform(-0.3, 0.3)) / corners;
        polygon.vertices.push_back(
            centre + turn * Point(size * std::cos(angle), size * aspect * std::sin(angle)));
    }
    orient(polygon.vertices);
    return polygon;
}

std::vector<PaintedPolygon> layer_polygons(const disk::SceneLayer& layer, double background,
                                           bool randomize, Random& random) {
    std::vector<PaintedPolygon> polygons;
    for (const auto& description : layer.polygon()) {
        PaintedPolygon polygon;
        polygon.reflectance = description.reflectance();
        polygon.contour = description.contour();
        for (int i = 0; i + 1 < description.xy_px_size(); i += 2) {
            polygon.vertices.emplace_back(description.xy_px(i), description.xy_px(i + 1));
        }
        orient(polygon.vertices);
        polygons.push_back(std::move(polygon));
    }
    if (layer.has_shape()) {
        disk::SceneShape shape = layer.shape();
        if (randomize && layer.variation().has_reflectance()) {
            shape.set_reflectance(draw(layer.variation().reflectance(), random));
        }
        // The hole of a P shows what is behind it.
        if (shape.kind() == disk::SceneShape::LETTER_P && !shape.has_window_reflectance()) {
            shape.set_window_reflectance(background);
        }
        for (auto& polygon : shape_polygons(shape)) polygons.push_back(std::move(polygon));
    }
    for (std::uint32_t i = 0; i < layer.clutter().count(); ++i) {
        polygons.push_back(clutter_polygon(layer.clutter(), random));
    }
    return polygons;
}

}  // namespace

DrawnScene draw_scene(const Scene& checked, std::uint64_t seed) {
    const disk::Scene& scene = checked.description();
    const bool randomize = scene.randomize();
    const double walk_s = scene.duration_s() > 0 ? scene.duration_s() : endless_walk_s;

    DrawnScene drawn;
    Random random(seed, sensor_stream);
    drawn.sensor = scene.sensor();
    if (randomize) vary(drawn.sensor, random);
    drawn.geometry = {static_cast<std::uint16_t>(drawn.sensor.width()),
                      static_cast<std::uint16_t>(drawn.sensor.height())};
    drawn.background_reflectance = randomize && scene.has_background()
                                       ? draw(scene.background(), random)
                                       : scene.background_reflectance();
    Random camera_random(seed, camera_stream);
    drawn.camera = Trajectory(scene.camera(), 0, walk_s, camera_random);

    std::uint32_t next_id = 1;
    for (int i = 0; i < scene.layer_size(); ++i) {
        const auto& description = scene.layer(i);
        Random layer_random(seed, first_layer_stream + static_cast<std::uint64_t>(i));
        disk::SceneTrajectory trajectory = description.trajectory();
        double delay_s = 0;
        double size = 1;
        if (randomize) {
            size = vary(trajectory, description.variation(), layer_random);
            delay_s = description.variation().delay_s() * layer_random.uniform();
        }
        // An isometry has no scale: what the trajectory states of one is the shape's size as well.
        if (description.transform() == disk::SceneLayer::ISOMETRY) {
            size *= trajectory.scale();
            trajectory.set_scale(1);
        }
        DrawnLayer layer;
        layer.polygons =
            layer_polygons(description, drawn.background_reflectance, randomize, layer_random);
        for (auto& polygon : layer.polygons) {
            for (Point& vertex : polygon.vertices) vertex *= size;
        }
        layer.trajectory = Trajectory(trajectory, delay_s, walk_s, layer_random);
        layer.camera_share = description.camera_share();
        layer.from_us = std::llround(description.from_s() * 1e6);
        if (description.has_to_s()) layer.to_us = std::llround(description.to_s() * 1e6);
        if (description.has_track()) {
            layer.tracked = TrackedShape{description.track(), next_id++, description.transform(),
                                         description.search(),
                                         contour_model(layer.polygons, description.model_points())};
        }
        drawn.layers.push_back(std::move(layer));
    }
    return drawn;
}

PlanarMap image_from_layer(const DrawnScene& scene, const DrawnLayer& layer, double t_s) {
    const PlanarMap world_from_layer = planar_map(layer.trajectory.at(t_s));
    const Placement camera = scene.camera.at(t_s);
    // p = c + zoom · R(-roll) (p_world - c - shift), c the middle of the image.
    const Point middle((scene.geometry.width - 1) / 2.0, (scene.geometry.height - 1) / 2.0);
    const Point shift = layer.camera_share * Point(camera.x_px, camera.y_px);
    PlanarMap image_from_world;
    const Eigen::Matrix2d a =
        camera.scale_x * Eigen::Rotation2Dd(-camera.theta_rad).toRotationMatrix();
    image_from_world.matrix.topLeftCorner<2, 2>() = a;
    image_from_world.matrix.topRightCorner<2, 1>() = middle - a * (middle + shift);
    return image_from_world * world_from_layer;
}

}  // namespace pursuit::sensor
