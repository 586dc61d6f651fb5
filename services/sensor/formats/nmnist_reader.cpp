// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/nmnist_reader.hpp"

#include <string>
#include <utility>

#include "services/sensor/formats/raw_settings.hpp"
#include "services/sensor/formats/records.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t nmnist_event_bytes = 5;
constexpr std::uint32_t time_marker_y = 240;
constexpr std::int64_t time_marker_us = 1 << 13;
constexpr Geometry nmnist{34, 34};
constexpr Geometry nmnist_camera{304, 240};

class NmnistReader final : public EventReader {
 public:
    NmnistReader(ByteWindow bytes, Geometry geometry, bool geometry_is_stated)
        : bytes_(std::move(bytes)), geometry_(geometry), geometry_is_stated_(geometry_is_stated) {}

    Geometry geometry() const override { return geometry_; }

 protected:
    Decoded decode(std::span<Event> events, std::span<Event> /*exposures*/) override {
        Decoded done;
        const auto records = records_ahead(bytes_, nmnist_event_bytes, "an event");
        if (!records) {
            done.error = records.error();
            return done;
        }
        done.goes_on = !records->empty();
        for (std::size_t i = 0; i < records->size() && done.count < events.size();
             i += nmnist_event_bytes) {
            const auto* at = records->data() + i;
            if (at[1] == time_marker_y) {
                markers_us_ += time_marker_us;
            } else if (auto cause = read_event(at, events[done.count])) {
                done.error = error_at(bytes_.name(), bytes_.offset(), *cause);
                return done;
            } else {
                ++done.count;
            }
            bytes_.consume(nmnist_event_bytes);
        }
        return done;
    }

 private:
    std::optional<std::string> read_event(const std::uint8_t* at, Event& event) {
        const std::uint32_t x = at[0];
        const std::uint32_t y = at[1];
        if (x >= geometry_.width || y >= geometry_.height) {
            return outside(x, y, geometry_) + (geometry_is_stated_ ? "" : ", assumed");
        }
        stored_us_.set((at[2] & 0x7f) << 16 | at[3] << 8 | at[4]);
        const auto t_us = stored_us_.value() + markers_us_;
        if (t_us < last_t_us_) return time_goes_back(last_t_us_, t_us);
        last_t_us_ = t_us;
        store(event, t_us, x, y, at[2] >> 7);
        return std::nullopt;
    }

    ByteWindow bytes_;
    Geometry geometry_;
    bool geometry_is_stated_;
    Unwrapped<23> stored_us_;
    std::int64_t markers_us_ = 0;  // what the markers so far have added
    std::int64_t last_t_us_ = 0;
};

/// The camera that the first events fit.
Result<Geometry> guess_geometry(ByteWindow& bytes) {
    const auto ahead = bytes.ahead(13'000 * nmnist_event_bytes);
    if (!ahead) return tl::unexpected(ahead.error());
    for (std::size_t i = 0; i + nmnist_event_bytes <= ahead->size(); i += nmnist_event_bytes) {
        const auto x = (*ahead)[i];
        const auto y = (*ahead)[i + 1];
        if (y != time_marker_y && (x >= nmnist.width || y >= nmnist.height)) return nmnist_camera;
    }
    return nmnist;
}

}  // namespace

Result<std::unique_ptr<EventReader>> open_nmnist(ByteWindow bytes, const ReadOptions& options) {
    const auto geometry =
        options.geometry ? Result<Geometry>(*options.geometry) : guess_geometry(bytes);
    if (!geometry) return tl::unexpected(geometry.error());
    return std::make_unique<NmnistReader>(std::move(bytes), *geometry, !!options.geometry);
}

}  // namespace pursuit::sensor
