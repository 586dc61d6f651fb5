// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "services/sensor/formats/event_reader.hpp"

namespace pursuit::sensor {

/// Everything a reader gives, and the error it ends with, empty for none.
struct ReadAll {
    std::vector<Event> events;
    std::string error;
};

inline ReadAll read_all(EventReader& reader, std::size_t at_a_time = 1000) {
    ReadAll all;
    std::vector<Event> block(at_a_time);
    for (;;) {
        const auto count = reader.read(block);
        if (!count) {
            all.error = count.error().message;
            return all;
        }
        if (*count == 0) return all;
        all.events.insert(all.events.end(), block.begin(),
                          block.begin() + static_cast<std::ptrdiff_t>(*count));
    }
}

}  // namespace pursuit::sensor
