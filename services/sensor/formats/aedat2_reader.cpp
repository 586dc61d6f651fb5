// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/aedat2_reader.hpp"

#include <optional>
#include <string>
#include <utility>

#include "services/sensor/formats/raw_settings.hpp"
#include "services/sensor/formats/records.hpp"
#include "services/sensor/formats/text_line.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::string_view magic = "#!AER-DAT";
constexpr std::size_t aedat2_event_bytes = 8;
constexpr std::size_t aedat2_longest_line = 4096;
constexpr int aedat2_most_lines = 1000;

/// A camera: what its addresses mean.
struct Chip {
    std::string_view name;
    Geometry geometry;
    std::uint32_t no_event;  ///< Any of these bits: something else than an event.
    std::uint32_t unused;    ///< Any of these bits: no address of this camera.
    int x_shift;
    std::uint32_t x_mask;
    int y_shift;
    std::uint32_t y_mask;
    int polarity_shift;
    std::uint32_t on;  ///< The polarity bit of an ON event.
};

constexpr std::uint32_t davis_no_event = 1U << 31 | 1U << 10;
constexpr Chip chips[] = {
    {"DVS128", {128, 128}, 1U << 15, 0xffff'0000, 1, 0x7f, 8, 0x7f, 0, 0},
    {"DAVIS240", {240, 180}, davis_no_event, 0, 12, 0x3ff, 22, 0x1ff, 11, 1},
    {"DAVIS346", {346, 260}, davis_no_event, 0, 12, 0x3ff, 22, 0x1ff, 11, 1},
};

std::uint32_t big_endian(const std::uint8_t* at) {
    return std::uint32_t{at[0]} << 24 | std::uint32_t{at[1]} << 16 | std::uint32_t{at[2]} << 8 |
           at[3];
}

class Aedat2Reader final : public EventReader {
 public:
    Aedat2Reader(ByteWindow bytes, Geometry geometry, const Chip& chip)
        : bytes_(std::move(bytes)), geometry_(geometry), chip_(chip) {}

    Geometry geometry() const override { return geometry_; }

 protected:
    Decoded decode(std::span<Event> events, std::span<Event> /*exposures*/) override {
        Decoded done;
        const auto records = records_ahead(bytes_, aedat2_event_bytes, "an event");
        if (!records) {
            done.error = records.error();
            return done;
        }
        done.goes_on = !records->empty();
        for (std::size_t i = 0; i < records->size() && done.count < events.size();
             i += aedat2_event_bytes) {
            const auto address = big_endian(records->data() + i);
            if ((address & chip_.no_event) == 0) {
                const auto stored_us = big_endian(records->data() + i + 4);
                if (auto cause = read_event(address, stored_us, events[done.count])) {
                    done.error = error_at(bytes_.name(), bytes_.offset(), *cause);
                    return done;
                }
                ++done.count;
            }
            bytes_.consume(aedat2_event_bytes);
        }
        return done;
    }

 private:
    std::optional<std::string> read_event(std::uint32_t address, std::uint32_t stored_us,
                                          Event& event) {
        if ((address & chip_.unused) != 0) {
            return "address " + std::to_string(address) + " is none of a " +
                   std::string(chip_.name);
        }
        const auto mirrored_x = address >> chip_.x_shift & chip_.x_mask;
        const auto y = address >> chip_.y_shift & chip_.y_mask;
        if (mirrored_x >= geometry_.width || y >= geometry_.height) {
            return outside(mirrored_x, y, geometry_) + " (x mirrored)";
        }
        stored_us_.set(stored_us);
        const auto t_us = stored_us_.value();
        if (t_us < last_t_us_) return time_goes_back(last_t_us_, t_us);
        last_t_us_ = t_us;
        const bool on = (address >> chip_.polarity_shift & 1) == chip_.on;
        store(event, t_us, geometry_.width - 1U - mirrored_x, y, on ? 1 : 0);
        return std::nullopt;
    }

    ByteWindow bytes_;
    Geometry geometry_;
    const Chip& chip_;
    Unwrapped<32> stored_us_;
    std::int64_t last_t_us_ = 0;
};

/// "# AEChip: eu.seebetter.ini.chips.davis.DAVIS240C" → DAVIS240; null where there is none such.
const Chip* chip_named(std::string_view name) {
    for (const auto& chip : chips) {
        if (name.find(chip.name) != std::string_view::npos) return &chip;
    }
    return nullptr;
}

/// Reads the header and returns the camera.
Result<const Chip*> read_header(ByteWindow& bytes) {
    const auto* chip = &chips[0];
    for (int lines = 0;; ++lines) {
        const auto fault = [&](const std::string& cause) {
            return tl::unexpected(error_at(bytes.name(), bytes.offset(), cause));
        };
        const auto line = bytes.line(aedat2_longest_line);
        if (!line) return tl::unexpected(line.error());
        if (lines == 0 && line->substr(0, magic.size() + 2) != "#!AER-DAT2.") {
            return fault(line->substr(0, magic.size()) == magic
                             ? "\"" + std::string(trimmed(*line)) +
                                   "\" is not read, only 2.0 (and 4)"
                             : "does not begin with \"#!AER-DAT2.0\"");
        }
        if (line->substr(0, 1) != "#") return chip;
        if (!is_text_line(*line)) {
            const auto cause = header_line_fault(*line, aedat2_longest_line);
            if (cause.empty()) return chip;
            return fault(cause);
        }
        if (lines == aedat2_most_lines) return fault("more than 1000 header lines");
        constexpr std::string_view key = "# AEChip:";
        if (line->substr(0, key.size()) == key) {
            auto rest = line->substr(key.size());
            const auto name = take_word(rest);
            chip = chip_named(name);
            if (chip == nullptr) {
                return fault("events of the camera \"" + std::string(name) +
                             "\" are not read, only of DVS128, DAVIS240 and DAVIS346");
            }
        }
        bytes.consume(line->size());
    }
}

}  // namespace

bool looks_like_aedat2(std::string_view head) {
    return head.substr(0, magic.size()) == magic && head.substr(magic.size(), 1) != "4";
}

Result<std::unique_ptr<EventReader>> open_aedat2(ByteWindow bytes, const ReadOptions& options) {
    const auto chip = read_header(bytes);
    if (!chip) return tl::unexpected(chip.error());
    const auto geometry = options.geometry.value_or((*chip)->geometry);
    return std::make_unique<Aedat2Reader>(std::move(bytes), geometry, **chip);
}

}  // namespace pursuit::sensor
