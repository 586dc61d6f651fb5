// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/gaussian_coverage.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "services/sensor/scene/active_pixels.hpp"
#include "services/sensor/scene/image_edges.hpp"

namespace pursuit::sensor {
namespace {

constexpr double edge_sigma_px = 0.6;

/// Brightness by brute force: the Gaussian summed over a fine grid of points, each as bright as
/// the frontmost polygon over it.
double brute_force(const DrawnScene& scene, double t_s, double x, double y) {
    std::vector<std::pair<std::vector<Point>, double>> polygons;
    for (const auto& layer : scene.layers) {
        const PlanarMap map = image_from_layer(scene, layer, t_s);
        for (const auto& polygon : layer.polygons) {
            std::vector<Point> vertices;
            for (const Point& v : polygon.vertices) vertices.push_back(map * v);
            polygons.emplace_back(vertices, polygon.reflectance);
        }
    }
    constexpr int half = 60;
    constexpr double step = 4.0 / half;
    double sum = 0;
    double weights = 0;
    for (int i = -half; i <= half; ++i) {
        for (int k = -half; k <= half; ++k) {
            const double weight = std::exp(-(i * i + k * k) * step * step / 2);
            // Turned, so that no edge lies along the grid.
            const Point p(x + (0.8 * i - 0.6 * k) * step * edge_sigma_px,
                          y + (0.6 * i + 0.8 * k) * step * edge_sigma_px);
            double seen = scene.background_reflectance;
            for (const auto& [vertices, reflectance] : polygons) {
                if (contains(vertices, p)) {
                    seen = reflectance;
                    break;
                }
            }
            sum += weight * seen;
            weights += weight;
        }
    }
    return sum / weights;
}

double worst_error(const std::string& layers, double t_s) {
    const auto scene = parse_scene(
        "name: \"s\" background_reflectance: 0.9 sensor { width: 40 height: 40 } " + layers, "s");
    EXPECT_TRUE(scene) << scene.error().message;
    const DrawnScene drawn = draw_scene(*scene, 1);
    ImageEdges edges(drawn, edge_sigma_px);
    for (std::size_t i = 0; i < drawn.layers.size(); ++i) {
        edges.place(i, image_from_layer(drawn, drawn.layers[i], t_s));
    }
    ActivePixels pixels(drawn.geometry, drawn.background_reflectance, 0.8);
    const auto brightness = pixels.brightness_of_all(edges);
    double worst = 0;
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 40; ++x) {
            const double error = brightness[y * 40 + x] - brute_force(drawn, t_s, x, y);
            worst = std::max(worst, std::abs(error));
        }
    }
    return worst;
}

TEST(GaussianCoverage, is_half_on_a_straight_edge_and_falls_off_as_the_normal_tail) {
    const auto& tables = GaussianCoverage::tables();
    for (const float h : {0.0F, 0.1F, 0.5F, 1.0F, 2.3F, 3.9F}) {
        EXPECT_NEAR(tables.tail(h), 0.5 * std::erfc(h / std::sqrt(2.0)), 1e-5) << h;
    }
    EXPECT_EQ(tables.tail(4.5F), 0);
}

TEST(GaussianCoverage, of_an_edge_part_is_owen_s_function) {
    // T(h, a): 1 / 2 pi · integral from 0 to a of exp(-h² (1 + x²) / 2) / (1 + x²).
    const auto& tables = GaussianCoverage::tables();
    for (const double h : {0.05, 0.4, 1.0, 1.7, 3.0}) {
        for (const double t : {0.02, 0.3, 1.0, 2.5, 3.8}) {
            const double a = t / h;
            constexpr int intervals = 20000;
            double sum = 0;
            for (int i = 0; i < intervals; ++i) {
                const double x = a * (i + 0.5) / intervals;
                sum += std::exp(-h * h * (1 + x * x) / 2) / (1 + x * x);
            }
            const double expected = sum * a / intervals / (2 * M_PI);
            EXPECT_NEAR(tables.edge_part(static_cast<float>(h), static_cast<float>(t)), expected,
                        1e-4)
                << h << " " << t;
            EXPECT_EQ(tables.edge_part(static_cast<float>(h), static_cast<float>(-t)),
                      -tables.edge_part(static_cast<float>(h), static_cast<float>(t)));
        }
    }
}

// Of the brute-force sum itself, over a fine grid cut by edges.
constexpr double brute_force_error = 6e-3;

TEST(Brightness, of_every_pixel_about_a_star_equals_brute_force) {
    EXPECT_LT(worst_error("layer { shape { kind: STAR size_px: 15 reflectance: 0.1 } trajectory { "
                          "x_px: 20.3 y_px: 19.8 theta_rad: 0.4 } }",
                          0),
              brute_force_error);
}

TEST(Brightness, of_every_pixel_about_a_thin_sliver_equals_brute_force) {
    EXPECT_LT(worst_error("layer { polygon { xy_px: [2, 5, 38, 7.3, 3, 5.9] reflectance: 0.05 } "
                          "polygon { xy_px: [30, 12, 30.4, 12, 30.3, 35] reflectance: 0.05 } }",
                          0),
              brute_force_error);
}

TEST(Brightness, of_every_pixel_about_a_concave_outline_equals_brute_force) {
    EXPECT_LT(worst_error("layer { polygon { xy_px: [4, 4, 36, 4, 36, 10, 11, 10, 11, 12.5, 36, "
                          "12.5, 36, 36, 20, 13.4, 4, 36] reflectance: 0.1 } }",
                          0),
              brute_force_error);
}

TEST(Brightness, of_every_pixel_under_stretch_and_shear_equals_brute_force) {
    EXPECT_LT(
        worst_error("layer { shape { kind: ARROW size_px: 12 reflectance: 0.1 } trajectory { "
                    "x_px: 20 y_px: 20 sine { target: SCALE_X amplitude: 0.4 frequency_hz: 1 } "
                    "sine { target: SHEAR amplitude: 0.5 frequency_hz: 1 } } }",
                    0.25),
        brute_force_error);
}

TEST(Brightness, of_every_pixel_of_a_tilted_plane_equals_brute_force) {
    EXPECT_LT(
        worst_error("layer { shape { kind: LETTER_H size_px: 14 reflectance: 0.1 } trajectory { "
                    "x_px: 20 y_px: 20 focal_px: 60 sine { target: TILT_X amplitude: 0.8 "
                    "frequency_hz: 1 } sine { target: TILT_Y amplitude: 0.5 frequency_hz: 1 } } }",
                    0.25),
        brute_force_error);
}

TEST(Brightness, inside_a_polygon_that_fills_the_image_is_its_reflectance) {
    EXPECT_LT(worst_error("layer { polygon { xy_px: [-500, -500, 500, -500, 500, 500, -500, 500] "
                          "reflectance: 0.3 } }",
                          0),
              1e-6);
}

}  // namespace
}  // namespace pursuit::sensor
