// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/region_of_interest.hpp"

namespace pursuit::sensor {
namespace {

class RegionOfInterest final : public Filter {
 public:
    RegionOfInterest(const FilterArguments& arguments, Geometry input)
        : input_(input),
          x_(arguments.whole<std::uint32_t>("x_px")),
          y_(arguments.whole<std::uint32_t>("y_px")),
          width_(arguments.whole<std::uint32_t>("width_px")),
          height_(arguments.whole<std::uint32_t>("height_px")),
          inside_(arguments["outside"] == 0) {}

    std::size_t apply(std::span<Event> events) override {
        return keep_if(events, [this](const Event& event) {
            // Before the begin wraps round to beyond the end.
            const bool inside = (event.x - x_ < width_) & (event.y - y_ < height_);
            return inside == inside_;
        });
    }

    Geometry geometry() const override { return input_; }
    bool by_pixel_alone() const override { return true; }

 private:
    Geometry input_;
    std::uint32_t x_, y_, width_, height_;
    bool inside_;
};

}  // namespace

Result<std::unique_ptr<Filter>> make_region_of_interest(const FilterArguments& arguments,
                                                        Geometry input) {
    const auto beyond = [&](const char* name, double end) {
        return fail(std::string("parameter ") + name + " is " + shown(arguments[name]) +
                    ", must be less than " + shown(end) + ", the image's");
    };
    if (arguments["x_px"] >= input.width) return beyond("x_px", input.width);
    if (arguments["y_px"] >= input.height) return beyond("y_px", input.height);
    return std::make_unique<RegionOfInterest>(arguments, input);
}

}  // namespace pursuit::sensor
