// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/refractory.hpp"

#include "services/sensor/filters/recent_times.hpp"

namespace pursuit::sensor {
namespace {

class Refractory final : public Filter {
 public:
    Refractory(const FilterArguments& arguments, Geometry input)
        : input_(input),
          period_us_(arguments.whole<std::uint32_t>("period_us")),
          by_polarity_(arguments["by_polarity"] != 0),
          passed_(std::size_t{2} * input.width * input.height, period_us_) {}

    std::size_t apply(std::span<Event> events) override {
        const std::size_t side = by_polarity_ ? 1 : 0;
        return keep_if(events, [this, side](const Event& event) {
            const auto now_us = passed_.now(event.t_us);
            auto& passed_us = *passed_.at((std::size_t{event.y} * input_.width + event.x) * 2 +
                                          (event.polarity & side));
            const bool pass = now_us - passed_us >= period_us_;
            passed_us = pass ? now_us : passed_us;
            return pass;
        });
    }

    Geometry geometry() const override { return input_; }

 private:
    Geometry input_;
    std::uint32_t period_us_;
    bool by_polarity_;
    RecentTimes passed_;  // last event passed, by (y·width + x)·2 + polarity
};

}  // namespace

Result<std::unique_ptr<Filter>> make_refractory(const FilterArguments& arguments, Geometry input) {
    return std::make_unique<Refractory>(arguments, input);
}

}  // namespace pursuit::sensor
