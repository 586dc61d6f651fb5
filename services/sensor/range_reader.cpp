// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/range_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pursuit::sensor {
namespace {

class RangeReader final : public EventReader {
 public:
    RangeReader(std::unique_ptr<EventReader> source, TimeRange range)
        : source_(std::move(source)), range_(range) {}

    Geometry geometry() const override { return source_->geometry(); }

 protected:
    Decoded decode(std::span<Event> events) override {
        const auto before = [](const Event& event, std::int64_t t_us) { return event.t_us < t_us; };
        while (!ended_) {
            const auto count = source_->read(events);
            if (!count) return {0, count.error()};
            if (*count == 0) break;
            auto first = events.begin();
            auto last = first + static_cast<std::ptrdiff_t>(*count);
            if (!started_) {
                first = std::lower_bound(first, last, range_.start_us, before);
                started_ = first != last;
            }
            if (range_.end_us != 0) {
                const auto stop = std::lower_bound(first, last, range_.end_us, before);
                ended_ = stop != last;
                last = stop;
            }
            if (first == last) continue;
            if (first != events.begin()) std::move(first, last, events.begin());
            return {static_cast<std::size_t>(last - first), {}};
        }
        return {};
    }

 private:
    std::unique_ptr<EventReader> source_;
    TimeRange range_;
    bool started_ = false;
    bool ended_ = false;
};

}  // namespace

Result<TimeRange> range_of_seconds(double start_s, double end_s) {
    constexpr double longest_s = 9e12;  // as us within 63 bits
    if (!(start_s >= 0 && start_s <= longest_s) || !(end_s >= 0 && end_s <= longest_s)) {
        return fail("a range must begin and end at 0 to 9e12 s");
    }
    const TimeRange range{std::llround(start_s * 1e6), std::llround(end_s * 1e6)};
    if (range.end_us != 0 && range.end_us <= range.start_us) {
        return fail("a range must end after it begins, or at 0 for the end of the source");
    }
    return range;
}

std::unique_ptr<EventReader> in_range(std::unique_ptr<EventReader> source, TimeRange range) {
    if (range.start_us == 0 && range.end_us == 0) return source;
    return std::make_unique<RangeReader>(std::move(source), range);
}

}  // namespace pursuit::sensor
