// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/hot_pixel.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pursuit::sensor {
namespace {

class HotPixel final : public Filter {
 public:
    HotPixel(const FilterArguments& arguments, Geometry input)
        : input_(input),
          window_us_(arguments.whole<std::int64_t>("window_ms") * 1000),
          least_(static_cast<std::uint32_t>(std::max(
              1.0, std::ceil(arguments["rate_hz"] * static_cast<double>(window_us_) * 1e-6)))),
          ratio_(arguments["ratio"]),
          pixels_(std::size_t{input.width} * input.height),
          counts_(pixels_),
          passes_(pixels_, 1) {}

    std::size_t apply(std::span<Event> events) override {
        if (!events.empty() && !begun_) {
            begun_ = true;
            end_us_ = events.front().t_us + window_us_;
        }
        return keep_if(events, [this](const Event& event) {
            if (event.t_us >= end_us_) end_window(event.t_us);
            const auto pixel = std::size_t{event.y} * input_.width + event.x;
            ++counts_[pixel];
            return passes_[pixel] != 0;
        });
    }

    Geometry geometry() const override { return input_; }

 private:
    void end_window(std::int64_t t_us) {
        const auto windows = (t_us - end_us_) / window_us_ + 1;
        end_us_ += windows * window_us_;
        std::fill(passes_.begin(), passes_.end(), std::uint8_t{1});
        if (windows == 1) {
            for (std::size_t pixel = 0; pixel < pixels_; ++pixel) {
                if (counts_[pixel] >= least_ && stands_out(pixel)) passes_[pixel] = 0;
            }
        }
        std::fill(counts_.begin(), counts_.end(), 0U);
    }

    bool stands_out(std::size_t pixel) const {
        const int x = static_cast<int>(pixel % input_.width);
        const int y = static_cast<int>(pixel / input_.width);
        std::uint64_t sum = 0;
        int neighbours = 0;
        for (int row = std::max(y - 1, 0); row <= std::min(y + 1, input_.height - 1); ++row) {
            for (int column = std::max(x - 1, 0); column <= std::min(x + 1, input_.width - 1);
                 ++column) {
                if (row == y && column == x) continue;
                sum += counts_[static_cast<std::size_t>(row) * input_.width +
                               static_cast<std::size_t>(column)];
                ++neighbours;
            }
        }
        return static_cast<double>(counts_[pixel]) * neighbours >=
               ratio_ * static_cast<double>(sum);
    }

    Geometry input_;
    std::int64_t window_us_;
    std::uint32_t least_;  // events in a window
    double ratio_;
    std::size_t pixels_;
    std::vector<std::uint32_t> counts_;  // of this window, by y·width + x
    std::vector<std::uint8_t> passes_;   // in this window
    bool begun_ = false;
    std::int64_t end_us_ = 0;  // of this window
};

}  // namespace

Result<std::unique_ptr<Filter>> make_hot_pixel(const FilterArguments& arguments, Geometry input) {
    return std::make_unique<HotPixel>(arguments, input);
}

}  // namespace pursuit::sensor
