// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/clamped.hpp"
#include "services/tracker/core/geometry/contour.hpp"

namespace pursuit::tracker {

/// Where the edge was when the light of each pixel crossed a level. A pixel fires each time its
/// light has moved by a threshold: so it crosses the same levels again when an edge comes back over
/// it, an event of the other polarity each, with the edge where it was on the way forth. For that
/// nobody needs to know how far from an edge its events come, nor how this pixel's thresholds, its
/// ground or the model here differ from the usual. Of a car that trembles before a camera this
/// tells the place to 0.1 px, where an event as such tells it to 0.4. But it tells of ways alone:
/// by what the pose was off then, it is off again.
///
/// A pixel is blind for a while after an event, and begins from what it sees then: its levels move
/// by most of the way that the edge goes meanwhile. Where that is a good part of a blurred edge
/// they tell nothing.
///
/// What others do to a pixel (the ground that passes behind the object, noise) changes the level
/// that it is at. Where its last event was not taken for this edge's, it is forgotten; how far the
/// rest can be trusted shows in how well it fits.
class PixelLevels {
 public:
    explicit PixelLevels(const Contour& contour) {
        const std::vector<Piece>& pieces = contour.pieces().pieces();
        edges_.reserve(pieces.size());
        for (const Piece& piece : pieces) {
            const double x = piece.bx - piece.ax;
            const double y = piece.by - piece.ay;
            const double length = std::hypot(x, y);
            const double per_length = length > 0 ? 1 / length : 0;
            edges_.push_back({static_cast<float>((piece.ax + piece.bx) / 2),
                              static_cast<float>((piece.ay + piece.by) / 2),
                              static_cast<float>(x * per_length),
                              static_cast<float>(y * per_length)});
        }
        while (side_bits_ < most_side_bits && (1U << side_bits_) < 2 * contour.radius_px()) {
            ++side_bits_;
        }
        pixels_.resize(std::size_t{1} << (2 * side_bits_));
    }

    /// The pose has been put elsewhere.
    void restart() {
        trust_ = trust_at_first;
        crossed_again_ = 0;
        if (++epoch_ != 0) return;
        std::fill(pixels_.begin(), pixels_.end(), Pixel());
        epoch_ = 1;
    }

    /// How long a pixel is blind after an event, as far as is known. That is told from above, and
    /// far above where events are rare: so no longer than usual.
    void set_blind_us(double blind_us) {
        moves_for_s_ = 1e-6 * of_blind * std::min(blind_us, usual_blind_us);
    }

    /// Whether levels tell anything of an object so fast.
    [[nodiscard]] bool tell_at(double speed_px_s) const {
        return speed_px_s * moves_for_s_ < most_moved_px;
    }

    struct Told {
        double place_px = 0;  ///< Of the pixel beside the edge, along its normal …
        bool is_known = false;
    };
    /// What the level tells that this event's pixel has crossed now, which fired last so long ago.
    /// The event is thought to be this piece's.
    [[gnu::always_inline]] Told cross(const Event& event, std::int64_t since_us,
                                      std::int32_t piece) {
        const std::size_t mask = (std::size_t{1} << side_bits_) - 1;
        Pixel& pixel = pixels_[(event.x & mask) | ((event.y & mask) << side_bits_)];
        const auto tile =
            static_cast<std::uint16_t>((event.x >> side_bits_) ^ ((event.y >> side_bits_) << 8));
        const auto before_us = static_cast<std::uint32_t>(event.t_us - since_us);
        if (pixel.t_us != before_us || pixel.tile != tile || pixel.epoch != epoch_ ||
            !is_same_edge(pixel.piece, piece)) {
            pixel = Pixel();
            pixel.tile = tile;
            pixel.epoch = epoch_;
            pixel.piece = static_cast<std::uint16_t>(piece);
        }
        pixel.t_us = static_cast<std::uint32_t>(event.t_us);
        pixel.level = (pixel.level + 2 * (event.polarity & 1U) + levels - 1) % levels;
        at_ = &pixel;
        const std::int16_t place = pixel.places[pixel.level];
        return {grain_px * (place + pixel.moved), place != unknown};
    }

    /// It was so far beside what was told, which is uncertain by this variance: the probability
    /// that it is right.
    double check(double beside_px, double variance_px2) {
        // Most lie within their σ, some far off (Student's t, 3 degrees of freedom).
        const double u = 1 + beside_px * beside_px / (3 * variance_px2);
        const double own = trust_ * 0.368 / (std::sqrt(variance_px2) * u * u);
        const double right = own / (own + (1 - trust_) * stray_density);
        trust_ = clamped(trust_ + memory * (right - trust_), least_trust, 1 - least_trust);
        return right;
    }

    /// Of the last hundred events or so, how many crossed a level again where it was thought to be:
    /// 0 … 1. Of an object that goes on as it went none do; of one that turns back and forth, many.
    [[nodiscard]] double crossed_again() const { return crossed_again_; }

    /// Where the pixel of cross() is, beside an edge that moves so fast along its normal; whether
    /// what was told of it was right.
    [[gnu::always_inline]] void learn(double place_px, double speed_px_s, bool was_right) {
        Pixel& pixel = *at_;
        const bool again = was_right && pixel.places[pixel.level] != unknown;
        crossed_again_ += memory * ((again ? 1 : 0) - crossed_again_);
        if (!was_right) pixel.places.fill(unknown);
        pixel.places[pixel.level] = fixed(place_px - grain_px * pixel.moved);
        // On a longer way another level takes this one's place.
        pixel.places[(pixel.level + levels / 2) % levels] = unknown;
        pixel.moved = fixed(grain_px * pixel.moved - speed_px_s * moves_for_s_);
    }

 private:
    static constexpr double usual_blind_us = 1000;
    // Of the way gone while blind. Where the light was steeper before, a level moves by less.
    static constexpr double of_blind = 0.75;
    static constexpr double most_moved_px = 0.3;  // of an edge 1.5 px wide
    // One on which events are for the same reasons where they are: farther on, and after a bend of
    // the contour, it is another.
    static constexpr float same_edge_px = 3;
    static constexpr float same_edge_cosine = 0.9F;
    static constexpr double trust_at_first = 0.5;
    static constexpr double memory = 0.01;  // of an event
    static constexpr double least_trust = 0.02;
    static constexpr double stray_density = 0.5;  // 1/px: anywhere on the blurred edge
    static constexpr int most_side_bits = 6;    // two sides of one object seldom share a place then
    static constexpr std::uint32_t levels = 8;  // about as many as an edge has
    static constexpr double grain_px = 1.0 / 256;
    static constexpr std::int16_t unknown = -32768;

    static std::int16_t fixed(double px) {
        const double grains = clamped(px / grain_px, -30'000, 30'000);
        return static_cast<std::int16_t>(grains + std::copysign(0.5, grains));
    }

    struct Edge {
        float x, y;              // of its middle, px
        float along_x, along_y;  // a unit
    };
    struct Pixel {
        Pixel() { places.fill(unknown); }

        std::array<std::int16_t, levels> places;
        std::uint32_t t_us = 0;  // of its last event
        std::uint32_t level = 0;
        std::uint16_t tile = 0;  // which of those that share this place
        std::uint16_t piece = 0;
        std::uint16_t epoch = 0;
        std::int16_t moved = 0;  // its levels are, all alike
    };
    static_assert(sizeof(Pixel) == 32);

    // (Of a contour of more than 65,536 pieces some are taken for others, and do not fit.)
    [[nodiscard, gnu::always_inline]] bool is_same_edge(std::uint16_t piece,
                                                        std::int32_t other) const {
        // (All of it at once: nobody could foresee whether it is the same piece.)
        const Edge& a = edges_[piece];
        const Edge& b = edges_[static_cast<std::size_t>(other)];
        const float x = a.x - b.x;
        const float y = a.y - b.y;
        const bool is_near = x * x + y * y < same_edge_px * same_edge_px;
        const bool is_along = a.along_x * b.along_x + a.along_y * b.along_y > same_edge_cosine;
        return (piece == static_cast<std::uint16_t>(other)) | (is_near & is_along);
    }

    std::vector<Edge> edges_;
    std::vector<Pixel> pixels_;  // by place in the image, modulo a tile of it
    int side_bits_ = 4;
    std::uint16_t epoch_ = 1;
    double moves_for_s_ = 1e-6 * of_blind * usual_blind_us;
    double trust_ = trust_at_first;
    double crossed_again_ = 0;
    Pixel* at_ = nullptr;
};

}  // namespace pursuit::tracker
