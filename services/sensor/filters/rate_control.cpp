// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/rate_control.hpp"

#include <cmath>

namespace pursuit::sensor {
namespace {

class RateControl final : public Filter {
 public:
    RateControl(std::uint64_t limit, std::int64_t window_us, Geometry input)
        : input_(input), limit_(limit), window_us_(window_us) {}

    std::size_t apply(std::span<Event> events) override {
        if (!events.empty() && !begun_) {
            begun_ = true;
            end_us_ = events.front().t_us + window_us_;
        }
        return keep_if(events, [this](const Event& event) {
            if (event.t_us >= end_us_) end_window(event.t_us);
            ++arrived_;
            if (passed_ >= limit_) return false;
            if (before_ > limit_) {
                // limit_ of every before_ events: the share as a fraction, without rounding.
                share_ += limit_;
                if (share_ < before_) return false;
                share_ -= before_;
            }
            ++passed_;
            return true;
        });
    }

    Geometry geometry() const override { return input_; }

 private:
    void end_window(std::int64_t t_us) {
        const auto windows = (t_us - end_us_) / window_us_ + 1;
        end_us_ += windows * window_us_;
        before_ = windows == 1 ? arrived_ : 0;
        arrived_ = 0;
        passed_ = 0;
        share_ = 0;
    }

    Geometry input_;
    std::uint64_t limit_;  // events a window
    std::int64_t window_us_;
    bool begun_ = false;
    std::int64_t end_us_ = 0;    // of this window
    std::uint64_t before_ = 0;   // events that arrived in the window before
    std::uint64_t arrived_ = 0;  // in this window
    std::uint64_t passed_ = 0;
    std::uint64_t share_ = 0;
};

}  // namespace

Result<std::unique_ptr<Filter>> make_rate_control(const FilterArguments& arguments,
                                                  Geometry input) {
    const double limit = std::floor(arguments["max_rate_hz"] * arguments["window_us"] * 1e-6);
    if (limit < 1) {
        return fail("parameter max_rate_hz is " + shown(arguments["max_rate_hz"]) +
                    ", must be at least " + shown(1e6 / arguments["window_us"]) +
                    " for a window_us of " + shown(arguments["window_us"]));
    }
    return std::make_unique<RateControl>(static_cast<std::uint64_t>(limit),
                                         arguments.whole<std::int64_t>("window_us"), input);
}

}  // namespace pursuit::sensor
