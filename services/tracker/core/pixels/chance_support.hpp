// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pursuit::tracker {

/// How many neighbours of a pixel fire shortly before it by chance: an edge fires in pixels next to
/// each other, but the more noise there is, the more of its events have a neighbour as well.
///
/// Noise comes from all pixels alike, the edges of things from some: so what fires in the quietest
/// quarter of the tiles of a box is the most noise that there can be.
class ChanceSupport {
 public:
    /// The box that is looked at, px; nothing has fired in it yet.
    void begin(int width_px, int height_px);
    /// A pixel of the box has fired; to be called once for each.
    void add(int x, int y) {
        if (x < columns_ * tile_px && y < rows_ * tile_px) {
            ++fired_[static_cast<std::size_t>(y / tile_px * columns_ + x / tile_px)];
        }
    }
    /// So many of its eight neighbours must have fired within a time for an event to stand out of
    /// the noise, of which this share has as many by chance; the box was looked at for over_us. 1
    /// where there is little noise.
    [[nodiscard]] int least_neighbours(double over_us, double within_us, double by_chance);

 private:
    static constexpr int tile_px = 16;  // a few dozen of its pixels fire in strong noise

    int columns_ = 0;
    int rows_ = 0;
    std::vector<std::int32_t> fired_;  // pixels, by tile
};

}  // namespace pursuit::tracker
