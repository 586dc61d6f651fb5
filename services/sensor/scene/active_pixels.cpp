// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/active_pixels.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::sensor {
ActivePixels::ActivePixels(Geometry geometry, double background_reflectance, double margin_px)
    : geometry_(geometry),
      background_(static_cast<float>(background_reflectance)),
      margin_px_(margin_px) {
    const std::size_t pixels = static_cast<std::size_t>(geometry.width) * geometry.height;
    head_.assign(pixels, none);
    fixed_head_.assign(pixels, none);
    layers_.assign(pixels, 0);
    const auto tiles = [](int extent) { return (extent + tile_px - 1) / tile_px; };
    tiles_.resize(static_cast<std::size_t>(tiles(geometry.width)) * tiles(geometry.height));
}

void ActivePixels::clear(const ImageEdges& edges) {
    for (const auto index : touched_) {
        head_[index] = none;
        layers_[index] = 0;
    }
    touched_.clear();
    nodes_.clear();
    pixels_.clear();
    terms_.clear();
    near_.clear();

    for (auto& tile : tiles_) tile.clear();
    const int columns = (geometry_.width + tile_px - 1) / tile_px;
    const auto tile_of = [](float v, int extent) {
        return static_cast<int>(std::clamp(v, 0.0F, static_cast<float>(extent - 1))) / tile_px;
    };
    const auto polygons = edges.polygons();
    const auto margin = static_cast<float>(margin_px_);
    for (std::uint32_t k = 0; k < polygons.size(); ++k) {
        const auto& p = polygons[k];
        const bool outside = p.x_high < -margin || p.y_high < -margin ||
                             p.x_low > static_cast<float>(geometry_.width) + margin ||
                             p.y_low > static_cast<float>(geometry_.height) + margin;
        if (outside) continue;
        const int left = tile_of(p.x_low - margin, geometry_.width);
        const int right = tile_of(p.x_high + margin, geometry_.width);
        const int top = tile_of(p.y_low - margin, geometry_.height);
        const int bottom = tile_of(p.y_high + margin, geometry_.height);
        for (int row = top; row <= bottom; ++row) {
            for (int column = left; column <= right; ++column) {
                tiles_[static_cast<std::size_t>(row * columns + column)].push_back(k);
            }
        }
    }
}

void ActivePixels::add_edge(const ImageEdges& edges, std::uint32_t e, bool activate) {
    const ImageEdge& edge = edges.edges()[e];
    const bool fixed = !fixed_done_;
    const float radius = ImageEdges::cut_sigmas * static_cast<float>(edges.sigma_px()) +
                         (fixed ? 0.0F : static_cast<float>(margin_px_));
    const float bx = edge.ax + edge.ux * edge.length;
    const float by = edge.ay + edge.uy * edge.length;
    const float low_x = std::min(edge.ax, bx) - radius;
    const float high_x = std::max(edge.ax, bx) + radius;
    const float low_y = std::max(std::min(edge.ay, by) - radius, 0.0F);
    const float high_y =
        std::min(std::max(edge.ay, by) + radius, static_cast<float>(geometry_.height - 1));
    if (!(low_y <= high_y)) return;
    const std::uint64_t layer_bit = std::uint64_t{1}
                                    << (edges.polygons()[edges.polygon_of(e)].layer % 64);
    const auto last_row = static_cast<int>(std::floor(high_y));
    for (auto row = static_cast<int>(std::ceil(low_y)); row <= last_row; ++row) {
        float left = low_x;
        float right = high_x;
        if (std::abs(edge.uy) > 1e-3F) {
            // |cross(u, p - a)| ≤ radius along this row.
            const float middle = edge.ax + edge.ux / edge.uy * (static_cast<float>(row) - edge.ay);
            const float half = radius / std::abs(edge.uy);
            left = std::max(left, middle - half);
            right = std::min(right, middle + half);
        }
        left = std::max(left, 0.0F);
        right = std::min(right, static_cast<float>(geometry_.width - 1));
        if (!(left <= right)) continue;
        const auto last = static_cast<int>(std::floor(right));
        for (auto column = static_cast<int>(std::ceil(left)); column <= last; ++column) {
            const float dx = static_cast<float>(column) - edge.ax;
            const float dy = static_cast<float>(row) - edge.ay;
            const float along = std::clamp(edge.ux * dx + edge.uy * dy, 0.0F, edge.length);
            const float away_x = dx - along * edge.ux;
            const float away_y = dy - along * edge.uy;
            if (away_x * away_x + away_y * away_y > radius * radius) continue;
            const auto index = static_cast<std::uint32_t>(row) * geometry_.width +
                               static_cast<std::uint32_t>(column);
            if (fixed) {
                fixed_nodes_.push_back({e, fixed_head_[index]});
                fixed_head_[index] = static_cast<std::uint32_t>(fixed_nodes_.size() - 1);
                continue;
            }
            if (head_[index] == none) touched_.push_back(index);
            nodes_.push_back({e, head_[index]});
            head_[index] = static_cast<std::uint32_t>(nodes_.size() - 1);
            if (activate) layers_[index] |= layer_bit;
        }
    }
}

void ActivePixels::add_fixed_edges(const ImageEdges& edges,
                                   const std::vector<LayerMotion>& motions) {
    if (fixed_done_) return;
    for (const auto& polygon : edges.polygons()) {
        if (motions[polygon.layer] != LayerMotion::fixed) continue;
        for (std::uint32_t i = 0; i < polygon.edge_count; ++i) {
            add_edge(edges, polygon.first_edge + i, false);
        }
    }
    fixed_done_ = true;
}

void ActivePixels::mark(const ImageEdges& edges, const std::vector<LayerMotion>& motions,
                        std::span<const std::int64_t> blind_until_us, std::int64_t horizon_us) {
    clear(edges);
    add_fixed_edges(edges, motions);
    for (const auto& polygon : edges.polygons()) {
        if (motions[polygon.layer] == LayerMotion::fixed) continue;
        const bool moving = motions[polygon.layer] == LayerMotion::moving;
        for (std::uint32_t i = 0; i < polygon.edge_count; ++i) {
            add_edge(edges, polygon.first_edge + i, moving);
        }
    }
    for (const auto index : touched_) {
        if (layers_[index] == 0) continue;
        if (!blind_until_us.empty() && blind_until_us[index] > horizon_us) continue;
        describe(edges, index, layers_[index]);
    }
}

void ActivePixels::describe(const ImageEdges& edges, std::uint32_t index, std::uint64_t layers) {
    scratch_.clear();
    for (auto n = head_[index]; n != none; n = nodes_[n].next) scratch_.push_back(nodes_[n].edge);
    for (auto n = fixed_head_[index]; n != none; n = fixed_nodes_[n].next) {
        scratch_.push_back(fixed_nodes_[n].edge);
    }
    std::sort(scratch_.begin(), scratch_.end());

    const auto row = index / geometry_.width;
    const auto column = index % geometry_.width;
    const auto x = static_cast<float>(column);
    const auto y = static_cast<float>(row);
    const auto polygons = edges.polygons();
    Pixel pixel{index, static_cast<std::uint32_t>(terms_.size()), 0, background_, layers, 0, 0};
    auto next = scratch_.begin();
    const auto add_term = [&](std::uint32_t polygon) {
        Term term{polygon, static_cast<std::uint32_t>(near_.size()), 0};
        while (next != scratch_.end() && edges.polygon_of(*next) == polygon) {
            near_.push_back(*next++);
            ++term.near_count;
        }
        terms_.push_back(term);
        ++pixel.term_count;
    };
    const auto columns = (static_cast<std::uint32_t>(geometry_.width) + tile_px - 1) / tile_px;
    bool covered = false;
    for (const auto k : tiles_[row / tile_px * columns + column / tile_px]) {
        while (next != scratch_.end() && edges.polygon_of(*next) < k) {
            add_term(edges.polygon_of(*next));
        }
        if (next != scratch_.end() && edges.polygon_of(*next) == k) {
            add_term(k);
        } else if (x >= polygons[k].x_low && x <= polygons[k].x_high && y >= polygons[k].y_low &&
                   y <= polygons[k].y_high && edges.inside(polygons[k], x, y)) {
            pixel.rest = polygons[k].reflectance;
            covered = true;
            break;
        }
    }
    while (!covered && next != scratch_.end()) add_term(edges.polygon_of(*next));
    float fastest = 0;
    for (auto e = scratch_.begin(); e != next; ++e) {
        fastest = std::max(fastest, edges.normal_share(*e));
    }
    pixel.normal_share = fastest;
    float darkest = pixel.rest;
    float brightest = pixel.rest;
    for (std::uint32_t i = 0; i < pixel.term_count; ++i) {
        const Term& term = terms_[pixel.first_term + i];
        darkest = std::min(darkest, polygons[term.polygon].reflectance);
        brightest = std::max(brightest, polygons[term.polygon].reflectance);
    }
    pixel.contrast = brightest - darkest;
    pixels_.push_back(pixel);
}

ActivePixels::Sight ActivePixels::sight(const ImageEdges& edges, const Pixel& pixel) const {
    const auto x = static_cast<float>(pixel.index % geometry_.width);
    const auto y = static_cast<float>(pixel.index / geometry_.width);
    float seen = 0;
    float open = 1;
    Nearness nearness;
    for (std::uint32_t i = 0; i < pixel.term_count; ++i) {
        const Term& term = terms_[pixel.first_term + i];
        const ImagePolygon& polygon = edges.polygons()[term.polygon];
        const float cover =
            edges.coverage(polygon, {&near_[term.first_near], term.near_count}, x, y, nearness);
        seen += open * cover * polygon.reflectance;
        open *= 1 - cover;
    }
    return {seen + open * pixel.rest, nearness};
}

std::vector<float> ActivePixels::brightness_of_all(const ImageEdges& edges) {
    std::vector<LayerMotion> all_moving;
    for (const auto& polygon : edges.polygons()) {
        all_moving.resize(polygon.layer + 1, LayerMotion::moving);
    }
    const bool fixed_done = std::exchange(fixed_done_, true);
    const auto fixed_head = std::exchange(fixed_head_, std::vector(fixed_head_.size(), none));
    mark(edges, all_moving, {}, 0);
    std::vector<float> all(head_.size());
    pixels_.clear();
    for (std::uint32_t index = 0; index < all.size(); ++index) {
        describe(edges, index, 0);
        all[index] = sight(edges, pixels_.back()).brightness;
        pixels_.clear();
        terms_.clear();
        near_.clear();
    }
    clear(edges);
    fixed_done_ = fixed_done;
    fixed_head_ = fixed_head;
    return all;
}

}  // namespace pursuit::sensor
