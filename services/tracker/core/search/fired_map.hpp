// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/common/event.hpp"

namespace pursuit::tracker {

/// Which pixels fired lately, and of each cell how far the next of them is. Large images have cells
/// of several pixels: at most 100,000 cells.
class FiredMap {
 public:
    /// Distances are whole thirds of a cell, up to this.
    static constexpr int farthest = 21;

    void build(Geometry geometry, std::span<const Event> events);
    /// How many pixels wide and high the cells of an image of this geometry are.
    [[nodiscard]] static int cell_px_of(Geometry geometry);

    [[nodiscard]] double cell_px() const { return cell_px_; }
    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }

    /// Thirds of a cell to the next cell that fired; the farthest outside the image.
    [[nodiscard]] int distance(int column, int row) const {
        const int x = column - left_;
        const int y = row - top_;
        if (x < 0 || y < 0 || x >= width_ || y >= height_) return farthest;
        return distance_[at(x, y)];
    }

    /// From the left and the top on, up to before the right and the bottom.
    struct Cells {
        int left = 0;
        int top = 0;
        int right = 0;
        int bottom = 0;
    };
    /// The image's cells in the square of this reach about a place: where shapes may be larger than
    /// it, there are many others, and none of them has fired.
    [[nodiscard]] Cells cells_near(double x_px, double y_px, double reach_px) const;

    /// The distances of cells in a row, from this one on.
    void copy_row(int row, int column, std::span<std::uint8_t> to) const;

    /// Over the square of cells around this one, cut at the image's border.
    struct Around {
        double fired = 0;     ///< How many cells fired.
        double mean = 0;      ///< Of the distances, thirds of a cell.
        double variance = 0;  ///< Of the distances.
    };
    [[nodiscard]] Around around(int column, int row, int half_side) const;

 private:
    void spread();
    void add_up();

    // Of the window; a rim of one cell is around it.
    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(width_ + 2) +
               static_cast<std::size_t>(x + 1);
    }

    double cell_px_ = 1;
    int columns_ = 0;
    int rows_ = 0;
    // What fired and what is near it: beyond this window all is farthest.
    int left_ = 0;
    int top_ = 0;
    int width_ = 0;
    int height_ = 0;
    std::vector<std::uint8_t> distance_;
    // Sums over everything in the window above and to the left, a row and a column more than it.
    struct Sums {
        std::uint32_t fired = 0;
        std::uint32_t distance = 0;
        std::uint32_t squared = 0;
    };
    std::vector<Sums> sums_;
};

}  // namespace pursuit::tracker
