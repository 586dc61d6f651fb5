// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/common/event.hpp"
#include "services/sensor/scene/image_edges.hpp"

namespace pursuit::sensor {

/// How a layer behaves until the next mark().
enum class LayerMotion : std::uint8_t {
    fixed,    ///< Never moves.
    resting,  ///< Does not move now.
    moving,
};

/// The pixels whose brightness can change now, and what each of them sees: the few edges near it,
/// front to back, down to the first polygon that covers it.
///
/// mark() finds them for polygons that will move by less than `margin_px`; after that sight()
/// follows the edges from where they are. Memory: proportional to the area of the bands about all
/// edges in the image.
class ActivePixels {
 public:
    struct Pixel {
        std::uint32_t index;  ///< y · width + x.
        std::uint32_t first_term;
        std::uint32_t term_count;
        float rest;            ///< Reflectance of what covers it behind the terms.
        std::uint64_t layers;  ///< Bit (layer mod 64) of each moving layer near it.
        float normal_share;    ///< How far edges near it move along their normals, as a share.
        float contrast;        ///< Between the darkest and the brightest that it may see.
    };

    ActivePixels(Geometry geometry, double background_reflectance, double margin_px);

    /// `blind_until_us`, by pixel: one that is blind until `horizon_us` is left out; empty: none
    /// is.
    void mark(const ImageEdges& edges, const std::vector<LayerMotion>& motions,
              std::span<const std::int64_t> blind_until_us, std::int64_t horizon_us);

    const std::vector<Pixel>& pixels() const { return pixels_; }

    struct Sight {
        float brightness;  ///< 0 … 1.
        Nearness nearness;
    };

    /// What an active pixel sees with the edges where they are now.
    Sight sight(const ImageEdges& edges, const Pixel& pixel) const;

    /// Brightness of every pixel, by index: whole, once.
    std::vector<float> brightness_of_all(const ImageEdges& edges);

    double margin_px() const { return margin_px_; }

    /// No edge that an active pixel does not know is nearer than this, where nothing has moved by
    /// more than `moved_px` since mark().
    float unknown_sigmas(const ImageEdges& edges, double moved_px) const {
        return ImageEdges::cut_sigmas +
               static_cast<float>((margin_px_ - moved_px) / edges.sigma_px());
    }

 private:
    static constexpr std::uint32_t none = 0xffffffffU;
    static constexpr int tile_px = 16;

    struct Node {
        std::uint32_t edge;
        std::uint32_t next;
    };

    /// A polygon whose edge is near.
    struct Term {
        std::uint32_t polygon;
        std::uint32_t first_near;
        std::uint32_t near_count;
    };

    void clear(const ImageEdges& edges);
    void add_edge(const ImageEdges& edges, std::uint32_t e, bool activate);
    void add_fixed_edges(const ImageEdges& edges, const std::vector<LayerMotion>& motions);
    void describe(const ImageEdges& edges, std::uint32_t index, std::uint64_t layers);

    Geometry geometry_;
    float background_;
    double margin_px_;

    std::vector<Pixel> pixels_;
    std::vector<Term> terms_;
    std::vector<std::uint32_t> near_;  // edges, sorted within a term

    std::vector<std::uint32_t> head_;                // by pixel: its first node
    std::vector<Node> nodes_;                        // of edges that may move
    std::vector<std::uint32_t> fixed_head_;          // by pixel
    std::vector<Node> fixed_nodes_;                  // of edges that never move: listed once
    std::vector<std::uint64_t> layers_;              // by pixel
    std::vector<std::uint32_t> touched_;             // pixels with nodes
    std::vector<std::vector<std::uint32_t>> tiles_;  // polygons over each tile, front to back
    std::vector<std::uint32_t> scratch_;
    bool fixed_done_ = false;
};

}  // namespace pursuit::sensor
