// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/es_reader.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "services/sensor/formats/es_layout.hpp"
#include "services/sensor/formats/records.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::ptrdiff_t es_event_bytes = es::event_bytes;

template <class Kind>
class EsReader final : public EventReader {
 public:
    EsReader(ByteWindow bytes, Geometry geometry) : bytes_(std::move(bytes)), geometry_(geometry) {}

    Geometry geometry() const override { return geometry_; }
    bool has_exposures() const override { return Kind::has_exposures; }

 protected:
    Decoded decode(std::span<Event> events, std::span<Event> exposures) override {
        Decoded done;
        auto ahead = bytes_.ahead(1);
        if (ahead && !ahead->empty() && !Kind::is_time(ahead->front())) {
            ahead = whole_event_ahead();
        }
        if (!ahead) {
            done.error = ahead.error();
            return done;
        }
        if (ahead->empty()) return done;
        decode_bytes(*ahead, events, exposures, done);
        done.time_us = t_us_;
        done.goes_on = true;
        return done;
    }

 private:
    /// Waits for the whole of the event that is ahead.
    Result<std::span<const std::uint8_t>> whole_event_ahead() {
        if (auto whole = records_ahead(bytes_, es_event_bytes, "an event"); !whole) return whole;
        return bytes_.at_hand();
    }

    void decode_bytes(std::span<const std::uint8_t> bytes, std::span<Event> events,
                      std::span<Event> exposures, Decoded& done) {
        const auto* at = bytes.data();
        const auto* const end = at + bytes.size();
        auto* event = events.data();
        auto* const events_end = event + events.size();
        // Measurements that nobody wants are all put into one place.
        Event unwanted;
        const std::size_t wanted = exposures.empty() ? 0 : 1;
        auto* exposure = wanted == 1 ? exposures.data() : &unwanted;
        auto* const exposures_end = exposure + (wanted == 1 ? exposures.size() : 1);
        const std::uint32_t width = geometry_.width;
        const std::uint32_t height = geometry_.height;
        auto t_us = t_us_;
        bool is_good = true;
        while (is_good) {
            // So many times there is an event to read, and room for it, whatever it is.
            auto safe = std::min(
                {(end - at) / es_event_bytes, events_end - event, exposures_end - exposure});
            if (safe == 0) break;
            for (; safe > 0; --safe) {
                const auto first = *at;
                if (Kind::is_time(first)) {
                    t_us += Kind::time_us(first);
                    ++at;
                    continue;
                }
                const auto pixel = load<std::uint32_t>(at + 1);
                const auto x = pixel & 0xffff;
                const auto y = pixel >> 16;
                is_good = (x < width) & (y < height);
                if (!is_good) {
                    done.error = error_at(bytes_.name(), bytes_.offset() + (at - bytes.data()),
                                          outside(x, y, geometry_) + " (y upwards)");
                    break;
                }
                t_us += Kind::delta_us(first);
                // Which of the two it is cannot be foreseen: no branch.
                const std::size_t measures = Kind::is_exposure(first);
                store(measures == 1 ? *exposure : *event, t_us, x, height - 1 - y,
                      Kind::polarity(first));
                event += 1 - measures;
                exposure += measures & wanted;
                at += es::event_bytes;
            }
        }
        // Behind the last whole event there may be bytes of time.
        for (; is_good && at != end && Kind::is_time(*at); ++at) t_us += Kind::time_us(*at);
        t_us_ = t_us;
        done.count = static_cast<std::size_t>(event - events.data());
        done.exposures = wanted == 1 ? static_cast<std::size_t>(exposure - exposures.data()) : 0;
        bytes_.consume(static_cast<std::size_t>(at - bytes.data()));
    }

    ByteWindow bytes_;
    Geometry geometry_;
    std::int64_t t_us_ = 0;
};

}  // namespace

bool looks_like_es(std::string_view head) { return head.substr(0, es::magic.size()) == es::magic; }

Result<std::unique_ptr<EventReader>> open_es(ByteWindow bytes, const ReadOptions& options) {
    const auto ahead = bytes.ahead(es::header_bytes);
    if (!ahead) return tl::unexpected(ahead.error());
    const auto at = [&](std::size_t byte, const std::string& cause) {
        return tl::unexpected(error_at(bytes.name(), byte, cause));
    };
    const auto header = ahead->first(std::min(ahead->size(), es::header_bytes));
    if (!looks_like_es({reinterpret_cast<const char*>(header.data()), header.size()})) {
        return at(0, "does not begin with \"Event Stream\"");
    }
    if (header.size() < es::header_bytes) return at(header.size(), "the file ends in its header");
    if (header[es::version_at] != 2) {
        return at(es::version_at, "version " + std::to_string(header[es::version_at]) + "." +
                                      std::to_string(header[es::version_at + 1]) +
                                      " of Event Stream is not read, only 2");
    }
    const Geometry stated{load<std::uint16_t>(header.data() + es::size_at),
                          load<std::uint16_t>(header.data() + es::size_at + 2)};
    const auto type = header[es::type_at];
    if (type != es::Dvs::type && type != es::Atis::type) {
        return at(es::type_at, "a stream of type " + std::to_string(type) +
                                   " holds neither DVS (1) nor ATIS events (2)");
    }
    const auto geometry = options.geometry.value_or(stated);
    if (geometry.width == 0 || geometry.height == 0) {
        return at(es::size_at, "the header states " + std::to_string(stated.width) + "x" +
                                   std::to_string(stated.height) + " pixels");
    }
    bytes.consume(es::header_bytes);
    std::unique_ptr<EventReader> reader;
    if (type == es::Atis::type) {
        reader = std::make_unique<EsReader<es::Atis>>(std::move(bytes), geometry);
    } else {
        reader = std::make_unique<EsReader<es::Dvs>>(std::move(bytes), geometry);
    }
    return reader;
}

}  // namespace pursuit::sensor
