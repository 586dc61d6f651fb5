// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/background_activity.hpp"

#include "services/sensor/filters/recent_times.hpp"

namespace pursuit::sensor {
namespace {

/// Last times of every pixel, with a border of pixels that never fire, so that each neighbourhood
/// is whole. The radius is known to the compiler: its loops unroll.
template <std::size_t radius>
class BackgroundActivity final : public Filter {
 public:
    BackgroundActivity(const FilterArguments& arguments, Geometry input)
        : input_(input),
          window_us_(arguments.whole<std::uint32_t>("window_us")),
          support_(arguments.whole<int>("support")),
          stride_(input.width + 2 * radius),
          plane_(stride_ * (input.height + 2 * radius)),
          polarities_(arguments["same_polarity"] != 0 ? 1 : 0),
          last_(plane_ * (polarities_ + 1), window_us_) {}

    std::size_t apply(std::span<Event> events) override {
        return keep_if(events, [this](const Event& event) {
            const auto now_us = last_.now(event.t_us);
            auto* corner =
                last_.at((event.polarity & polarities_) * plane_ + event.y * stride_ + event.x);
            auto& own = corner[radius * stride_ + radius];
            const auto since_us = now_us - window_us_;
            int active = -static_cast<int>(own >= since_us);
            for (std::size_t row = 0; row <= 2 * radius && active < support_; ++row) {
                const auto* at = corner + row * stride_;
                for (std::size_t column = 0; column <= 2 * radius; ++column) {
                    active += static_cast<int>(at[column] >= since_us);
                }
            }
            own = now_us;
            return active >= support_;
        });
    }

    Geometry geometry() const override { return input_; }

 private:
    Geometry input_;
    std::uint32_t window_us_;
    int support_;
    std::size_t stride_;      // pixels of a row, with the border
    std::size_t plane_;       // pixels of one polarity
    std::size_t polarities_;  // 1: a plane for each, 0: one for both
    RecentTimes last_;        // event of each pixel
};

}  // namespace

Result<std::unique_ptr<Filter>> make_background_activity(const FilterArguments& arguments,
                                                         Geometry input) {
    const auto radius = arguments.whole<int>("radius_px");
    const int neighbours = (2 * radius + 1) * (2 * radius + 1) - 1;
    if (arguments["support"] > neighbours) {
        return fail("parameter support is " + shown(arguments["support"]) + ", must be at most " +
                    std::to_string(neighbours) + " for a radius_px of " + std::to_string(radius));
    }
    switch (radius) {
        case 1:
            return std::make_unique<BackgroundActivity<1>>(arguments, input);
        case 2:
            return std::make_unique<BackgroundActivity<2>>(arguments, input);
        default:
            return std::make_unique<BackgroundActivity<3>>(arguments, input);
    }
}

}  // namespace pursuit::sensor
