// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "services/sensor/formats/byte_source.hpp"
#include "services/sensor/formats/event_reader.hpp"
#include "services/sensor/formats/event_writer.hpp"

namespace pursuit::sensor {

struct ReadOptions {
    /// The name of the format; where empty it is told by the file's name and first bytes.
    std::string format;
    /// Instead of what the file states, or of the format's default where it states nothing.
    std::optional<Geometry> geometry;
    /// The stream may be joined after it began, as a live one: events before the first word of time
    /// are skipped and counted (EventReader::events_skipped()), and no error.
    bool joined_late = false;
};

/// A file format: one file of code, and one line in the table of formats.cpp.
struct Format {
    std::string_view name;
    std::string_view what;                       ///< One line for people.
    std::array<std::string_view, 2> extensions;  ///< With the dot; unused ones empty.

    /// Whether a file may begin like this; `head` is up to 4096 bytes. Null: told by name alone.
    bool (*recognises)(std::string_view head);

    Result<std::unique_ptr<EventReader>> (*open)(ByteWindow bytes, const ReadOptions& options);

    /// Null where the format is only read.
    /// `exposures`: exposure measurements are to be held, where the format can
    /// (EventWriter::holds_exposures()).
    Result<std::unique_ptr<EventWriter>> (*create)(const std::string& path, Geometry geometry,
                                                   bool exposures);
};

std::span<const Format> formats();

/// Opens a recording. Told by extension first, by content where that leaves a choice.
Result<std::unique_ptr<EventReader>> open_events(const std::string& path,
                                                 const ReadOptions& options = {});
Result<std::unique_ptr<EventReader>> open_events(std::unique_ptr<ByteSource> source,
                                                 const ReadOptions& options = {});

/// Creates a recording in the format of its extension; `exposures` as for Format::create.
Result<std::unique_ptr<EventWriter>> create_events(const std::string& path, Geometry geometry,
                                                   bool exposures = false);

/// The format that a file of this name and beginning is in; an error where none or several fit.
Result<const Format*> find_format(const std::string& path, std::string_view head);

}  // namespace pursuit::sensor
