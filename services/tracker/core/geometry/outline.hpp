// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "services/tracker/core/geometry/contour.hpp"

namespace pursuit::tracker {

/// A contour as at most 512 parts, and what came from each: how far it moved across itself, which
/// is what makes events, and how many came.
class Outline {
 public:
    static constexpr std::size_t most_parts = 512;

    struct Part {
        Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();  ///< Model frame.
        Eigen::Vector2d along_px = Eigen::Vector2d::Zero();   ///< Its direction, as long as it is.
        double events = 0;       ///< Since the last clear(), by their weights.
        bool is_hidden = false;  ///< By another object, as far as known.
        double blind = 0;        ///< How often it comes over blind pixels of late, 0 … 1.
    };

    Outline() = default;
    /// Up to 512 pieces are a part each; of more, several that follow each other are one.
    explicit Outline(const Contour& contour) {
        const std::vector<Piece>& pieces = contour.pieces().pieces();
        const std::size_t of_one = (pieces.size() + most_parts - 1) / most_parts;
        part_of_.reserve(pieces.size());
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const Piece& piece = pieces[i];
            const Eigen::Vector2d along(piece.bx - piece.ax, piece.by - piece.ay);
            if (i % of_one == 0) {
                parts_.push_back({{(piece.ax + piece.bx) / 2, (piece.ay + piece.by) / 2}, along});
            } else {
                Eigen::Vector2d& of_part = parts_.back().along_px;
                const double length_px = of_part.norm();
                if (length_px > 0) of_part *= 1 + along.norm() / length_px;
            }
            part_of_.push_back(static_cast<std::uint16_t>(parts_.size() - 1));
        }
    }

    void count(std::int32_t piece, double weight) {
        parts_[part_of_[static_cast<std::size_t>(piece)]].events += weight;
        is_empty_ = false;
    }
    /// Nothing has come yet; what is hidden stays so.
    void clear() {
        if (is_empty_) return;
        for (Part& part : parts_) part.events = 0;
        is_empty_ = true;
    }
    /// Nothing has come since the last clear().
    [[nodiscard]] bool is_empty() const { return is_empty_; }
    /// Nothing is hidden.
    void show_all() {
        for (Part& part : parts_) part.is_hidden = false;
    }

    /// A part comes over blind pixels so often.
    void set_blind(Part& part, double blind) {
        part.blind = blind;
        has_blind_ |= blind > 0;
    }
    /// Each of them that much less often.
    void fade_blind(double factor) {
        if (!has_blind_) return;
        has_blind_ = false;
        for (Part& part : parts_) {
            part.blind = part.blind * factor > least_blind ? part.blind * factor : 0;
            has_blind_ |= part.blind > 0;
        }
    }

    [[nodiscard]] std::vector<Part>& parts() { return parts_; }
    [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
    [[nodiscard]] bool is_hidden(std::int32_t piece) const { return part_of(piece).is_hidden; }
    /// Whether this piece can make events: neither is it hidden nor are the pixels blind that it
    /// comes over.
    [[nodiscard]] bool can_be_seen(std::int32_t piece) const {
        const Part& part = part_of(piece);
        return !part.is_hidden && part.blind < 0.5;
    }

 private:
    [[nodiscard]] const Part& part_of(std::int32_t piece) const {
        return parts_[part_of_[static_cast<std::size_t>(piece)]];
    }

    static constexpr double least_blind = 0.01;

    std::vector<Part> parts_;
    bool is_empty_ = true;
    bool has_blind_ = false;
    std::vector<std::uint16_t> part_of_;  // by piece
};

}  // namespace pursuit::tracker
