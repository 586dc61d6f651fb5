// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/dat_header.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>

#include "services/sensor/formats/event_reader.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t dat_longest_line = 4096;
constexpr int dat_most_lines = 1000;
constexpr std::uint8_t dat_stated_event_bytes = 8;
constexpr int largest_dat_side = 1 << 14;  // an event has 14 bits for x and for y

/// The next word of `line`, which loses it.
std::string_view take_word(std::string_view& line) {
    const auto begin = std::min(line.find_first_not_of(" \t:\r\n"), line.size());
    const auto end = std::min(line.find_first_of(" \t:\r\n", begin), line.size());
    const auto word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

struct Fields {
    int version = 0;
    int width = 0;
    int height = 0;
};

/// Reads "Width 304" and the like; other lines are remarks.
Result<void> read_field(std::string_view line, Fields& fields) {
    const auto key = take_word(line);
    int* field = key == "Version"  ? &fields.version
                 : key == "Width"  ? &fields.width
                 : key == "Height" ? &fields.height
                                   : nullptr;
    if (field == nullptr) return {};
    const auto word = take_word(line);
    const int most = key == "Version" ? 2 : largest_dat_side;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *field);
    if (error != std::errc() || end != word.data() + word.size() || *field < 1 || *field > most) {
        return fail(std::string(key) + " \"" + std::string(word) + "\" is not a number from 1 to " +
                    std::to_string(most));
    }
    return {};
}

Result<void> read_type_and_size(ByteWindow& bytes) {
    const auto ahead = bytes.ahead(2);
    if (!ahead) return tl::unexpected(ahead.error());
    const auto at = [&](int index, const std::string& cause) {
        return tl::unexpected(error_at(bytes.name(), bytes.offset() + index, cause));
    };
    if (ahead->size() < 2) return at(0, "the file ends before the type and size of its events");
    const int type = (*ahead)[0];
    const int size = (*ahead)[1];
    // 0: Event2d of the first cameras; 12: EventCD, the same bits.
    if (type != 0 && type != 12) {
        return at(0, "events of type " + std::to_string(type) +
                         " are not change detection events (0 or 12)");
    }
    if (size != dat_stated_event_bytes) {
        return at(1, "events of " + std::to_string(size) + " bytes, must be 8");
    }
    bytes.consume(2);
    return {};
}

}  // namespace

Result<DatHeader> read_dat_header(ByteWindow& bytes) {
    Fields fields;
    for (int lines = 0;; ++lines) {
        const auto first = bytes.ahead(1);
        if (!first) return tl::unexpected(first.error());
        if (first->empty() || first->front() != '%') {
            if (lines == 0) return DatHeader{};
            break;
        }
        const auto line = bytes.line(dat_longest_line);
        if (!line) return tl::unexpected(line.error());
        const bool ends = line->back() == '\n';
        if (!ends || lines == dat_most_lines) {
            return tl::unexpected(
                error_at(bytes.name(), bytes.offset(),
                         ends ? "more than 1000 header lines" : "a header line does not end"));
        }
        if (auto ok = read_field(line->substr(1), fields); !ok) {
            return tl::unexpected(error_at(bytes.name(), bytes.offset(), ok.error().message));
        }
        bytes.consume(line->size());
    }
    if ((fields.width == 0) != (fields.height == 0)) {
        return tl::unexpected(error_at(bytes.name(), bytes.offset(),
                                       fields.width == 0
                                           ? "the header states Height but no Width"
                                           : "the header states Width but no Height"));
    }
    if (auto ok = read_type_and_size(bytes); !ok) return tl::unexpected(ok.error());
    DatHeader header;
    if (fields.version != 0) header.version = fields.version;
    if (fields.width != 0) {
        header.geometry = Geometry{static_cast<std::uint16_t>(fields.width),
                                   static_cast<std::uint16_t>(fields.height)};
    }
    return header;
}

}  // namespace pursuit::sensor
