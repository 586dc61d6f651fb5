// SPDX-License-Identifier: Apache-2.0
// One decoder fed with anything: it must end, in bounded memory, with events that keep the readers'
// contract. The last byte of the input says how it is read, so that recordings are seeds as they
// are.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "services/sensor/formats/formats.hpp"

/// Defined for each fuzzer: the name of its format.
extern const char* const fuzzed_format;

namespace pursuit::sensor {
namespace {

/// Gives the bytes a few at a time, as a live source does.
class Trickle final : public ByteSource {
 public:
    Trickle(std::span<const std::uint8_t> bytes, std::size_t at_a_time)
        : rest_(bytes), at_a_time_(at_a_time) {}
    const std::string& name() const override { return name_; }
    Result<std::size_t> read(std::span<std::uint8_t> bytes) override {
        const auto n = std::min({bytes.size(), rest_.size(), at_a_time_});
        std::copy_n(rest_.begin(), n, bytes.begin());
        rest_ = rest_.subspan(n);
        return n;
    }

 private:
    std::string name_ = "input";
    std::span<const std::uint8_t> rest_;
    std::size_t at_a_time_;
};

void require(bool condition, const char* what) {
    if (condition) return;
    std::fprintf(stderr, "broken: %s\n", what);
    std::abort();
}

/// Each in order and none before what an earlier call gave; within the array; polarity 0 or 1.
void check(std::span<const Event> block, std::int64_t earliest_us, Geometry geometry) {
    for (const auto& event : block) {
        require(event.t_us >= earliest_us, "time goes back");
        require(event.x < geometry.width && event.y < geometry.height, "outside");
        require(event.polarity <= 1, "polarity");
        earliest_us = event.t_us;
    }
}

void read_everything(std::span<const std::uint8_t> bytes, unsigned how) {
    ReadOptions options;
    options.format = fuzzed_format;
    options.joined_late = (how & 1) != 0;
    if ((how & 2) != 0) options.geometry = Geometry{304, 240};
    auto source = (how & 4) != 0 ? std::make_unique<Trickle>(bytes, 1 + (how >> 5))
                                 : from_memory("input", bytes);
    auto reader = open_events(std::move(source), options);
    if (!reader) {
        require(reader.error().message.rfind("input: byte ", 0) == 0, "an error without a place");
        return;
    }
    const auto geometry = (*reader)->geometry();
    std::vector<Event> events((how & 8) != 0 ? 3 : 500);
    std::vector<Event> exposures((how & 16) != 0 ? 0 : events.size());
    for (;;) {
        const auto earliest_us = (*reader)->time_us();
        const auto batch = (*reader)->read(events, exposures);
        if (!batch) {
            require(batch.error().message.rfind("input: byte ", 0) == 0,
                    "an error without a place");
            require(!(*reader)->read(events), "an error that does not stay");
            return;
        }
        check(std::span(events).first(batch->events), earliest_us, geometry);
        check(std::span(exposures).first(batch->exposures), earliest_us, geometry);
        if (batch->at_end) return;
    }
}

}  // namespace
}  // namespace pursuit::sensor

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    pursuit::sensor::read_everything({data, size - 1}, data[size - 1]);
    return 0;
}
