// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/polarity.hpp"

namespace pursuit::sensor {
namespace {

class Polarity final : public Filter {
 public:
    Polarity(const FilterArguments& arguments, Geometry input)
        : input_(input),
          keep_(arguments.whole<unsigned>("keep")),
          flip_(arguments.whole<std::uint8_t>("invert")) {}

    std::size_t apply(std::span<Event> events) override {
        std::size_t kept = 0;
        for (Event event : events) {
            const bool pass = keep_ == 2 || event.polarity == keep_;
            event.polarity ^= flip_;
            events[kept] = event;
            kept += static_cast<std::size_t>(pass);
        }
        return kept;
    }

    Geometry geometry() const override { return input_; }

 private:
    Geometry input_;
    unsigned keep_;
    std::uint8_t flip_;
};

}  // namespace

Result<std::unique_ptr<Filter>> make_polarity(const FilterArguments& arguments, Geometry input) {
    return std::make_unique<Polarity>(arguments, input);
}

}  // namespace pursuit::sensor
