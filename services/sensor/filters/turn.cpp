// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/turn.hpp"

#include <utility>

namespace pursuit::sensor {
namespace {

/// Any of the eight ways to lay an image on its grid: transpose, then flip.
struct Orientation {
    bool transposed = false;
    bool flipped_x = false;
    bool flipped_y = false;

    void transpose() {
        transposed = !transposed;
        std::swap(flipped_x, flipped_y);
    }
    void flip_x() { flipped_x = !flipped_x; }
    void flip_y() { flipped_y = !flipped_y; }
    /// By 90 degrees, clockwise as seen with y downwards: (x, y) goes to (height-1-y, x).
    void rotate() {
        transpose();
        flip_x();
    }
};

class Turn final : public Filter {
 public:
    Turn(Orientation orientation, Geometry output)
        : orientation_(orientation),
          output_(output),
          // c - x for a flipped axis, c + x otherwise: (x ^ m) + c with m all ones negates.
          mask_x_(orientation.flipped_x ? 0xffff : 0),
          mask_y_(orientation.flipped_y ? 0xffff : 0),
          add_x_(orientation.flipped_x ? output.width : 0),
          add_y_(orientation.flipped_y ? output.height : 0) {}

    std::size_t apply(std::span<Event> events) override {
        if (orientation_.transposed) {
            for (Event& event : events) std::swap(event.x, event.y);
        }
        for (Event& event : events) {
            // 16 bits wide, ~x + width is width-1-x.
            event.x = static_cast<std::uint16_t>((event.x ^ mask_x_) + add_x_);
            event.y = static_cast<std::uint16_t>((event.y ^ mask_y_) + add_y_);
        }
        return events.size();
    }

    Geometry geometry() const override { return output_; }
    bool by_pixel_alone() const override { return true; }

 private:
    Orientation orientation_;
    Geometry output_;
    unsigned mask_x_, mask_y_, add_x_, add_y_;
};

}  // namespace

Result<std::unique_ptr<Filter>> make_turn(const FilterArguments& arguments, Geometry input) {
    const int angle_deg = arguments.whole<int>("rotate_deg");
    if (angle_deg % 90 != 0) {
        return fail("parameter rotate_deg is " + std::to_string(angle_deg) +
                    ", must be 0, 90, 180 or 270");
    }
    Orientation orientation;
    if (arguments["transpose"] != 0) orientation.transpose();
    for (int turned_deg = 0; turned_deg < angle_deg; turned_deg += 90) orientation.rotate();
    if (arguments["flip_x"] != 0) orientation.flip_x();
    if (arguments["flip_y"] != 0) orientation.flip_y();
    if (orientation.transposed) {
        // A packet has 15 bits for y.
        if (input.width > 32768) {
            return fail("the image would have " + std::to_string(input.width) +
                        " rows, at most 32768 are possible");
        }
        std::swap(input.width, input.height);
    }
    return std::make_unique<Turn>(orientation, input);
}

}  // namespace pursuit::sensor
