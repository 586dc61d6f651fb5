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
    bool has_exposures() const override { return source_->has_exposures(); }

 protected:
    Decoded decode(std::span<Event> events, std::span<Event> exposures) override {
        Decoded done;
        if (ended_) return done;
        const auto batch = source_->read(events, exposures);
        if (!batch) {
            done.error = batch.error();
            return done;
        }
        done.count = cut(events.first(batch->events));
        done.exposures = cut(exposures.first(batch->exposures));
        done.skipped = source_->events_skipped() - events_skipped();
        // Time before the range is none of its own: nobody is to wait for it.
        done.time_us = source_->time_us() < range_.start_us ? 0 : source_->time_us();
        if (range_.end_us != 0 && done.time_us >= range_.end_us) {
            ended_ = true;
            done.time_us = range_.end_us;
        }
        done.goes_on = !batch->at_end && !ended_;
        return done;
    }

 private:
    /// Moves what is in the range to the front and returns how many there are.
    std::size_t cut(std::span<Event> block) const {
        const auto at = [&](std::int64_t t_us) {
            return std::lower_bound(
                block.begin(), block.end(), t_us,
                [](const Event& event, std::int64_t time_us) { return event.t_us < time_us; });
        };
        const auto first = at(range_.start_us);
        const auto last = range_.end_us == 0 ? block.end() : at(range_.end_us);
        if (first != block.begin()) std::move(first, last, block.begin());
        return static_cast<std::size_t>(last - first);
    }

    std::unique_ptr<EventReader> source_;
    TimeRange range_;
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
