// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/sensor/scene/drawn_scene.hpp"
#include "services/sensor/scene/gaussian_coverage.hpp"
#include "services/sensor/scene/planar_map.hpp"

namespace pursuit::sensor {

/// One edge of a polygon in the image, px.
struct ImageEdge {
    float ax;  ///< Where it begins.
    float ay;
    float ux;  ///< Its direction, length 1; the inside lies where cross(u, p - a) > 0.
    float uy;
    float length;
};

struct ImagePolygon {
    std::uint32_t layer;
    std::uint32_t first_edge;
    std::uint32_t edge_count;
    float reflectance;
    float x_low = 0;  ///< Bounding box, px.
    float x_high = 0;
    float y_low = 0;
    float y_high = 0;
};

/// The edges near a pixel, from its sight of them.
struct Nearness {
    float sigmas = 1e9F;      ///< To the nearest edge of those looked at.
    std::uint32_t count = 0;  ///< How many are within ImageEdges::cut_sigmas.
};

/// Every polygon of a scene in the image, front to back, where its layer was placed last; and how
/// much of a pixel they cover: exactly, for a pixel whose sensitivity is Gaussian.
class ImageEdges {
 public:
    /// `sigma_px`: of a pixel's sensitivity, optics and pixel area together.
    ImageEdges(const DrawnScene& scene, double sigma_px);

    /// Moves the polygons of one layer.
    void place(std::size_t layer, const PlanarMap& image_from_layer);

    /// Notes how the layer's edges move from one place to another: normal_share() is how far an
    /// edge moves along its normal there, as a share of `whole_px`, at most 1.
    void note_motion(std::size_t layer, const PlanarMap& from, const PlanarMap& to,
                     double whole_px);

    float normal_share(std::uint32_t edge) const { return normal_share_[edge]; }

    std::span<const ImagePolygon> polygons() const { return polygons_; }
    std::span<const ImageEdge> edges() const { return edges_; }
    std::uint32_t polygon_of(std::uint32_t edge) const { return polygon_of_[edge]; }
    double sigma_px() const { return sigma_px_; }

    /// Nearer than this an edge counts; the jump there is 2e-4 of its contrast.
    static constexpr float cut_sigmas = 3.5F;

    /// Share of the pixel at (x, y) that `polygon` covers; `near` names every edge of it within
    /// GaussianCoverage::reach · sigma_px, ascending, at least one. Adds to `nearness`.
    float coverage(const ImagePolygon& polygon, std::span<const std::uint32_t> near, float x,
                   float y, Nearness& nearness) const {
        return coverage(polygon, near, x, y, nearness, true);
    }

    /// Whether the point is inside `polygon`.
    bool inside(const ImagePolygon& polygon, float x, float y) const;

 private:
    float coverage(const ImagePolygon& polygon, std::span<const std::uint32_t> near, float x,
                   float y, Nearness& nearness, bool may_step_aside) const;

    double sigma_px_;
    float per_sigma_;
    const GaussianCoverage& gaussian_ = GaussianCoverage::tables();
    std::vector<ImagePolygon> polygons_;
    std::vector<ImageEdge> edges_;
    std::vector<Point> layer_vertices_;         // edge i begins at vertex i, in its layer's frame
    std::vector<std::uint32_t> polygon_of_;     // by edge
    std::vector<std::uint8_t> convex_end_;      // by edge: the inside is convex where it ends
    std::vector<float> normal_share_;           // by edge
    std::vector<std::uint32_t> first_polygon_;  // by layer, and one past the last
};

}  // namespace pursuit::sensor
