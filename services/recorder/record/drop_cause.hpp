// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace pursuit::recorder {

/// Why a message that was sent is not in the file.
enum class DropCause : std::uint8_t {
    transport,   ///< A writer's sequence numbers jumped: it never came here.
    queue_full,  ///< The disk was slower than the samples for longer than the queue lasts.
    paused,      ///< By request.
    disk,        ///< It could not be written, or lay in a chunk that could not.
    refused,     ///< Too large for a file, or the file's bounds for definitions are reached.
    stopping,    ///< It waited when the process had to end.
};
inline constexpr std::array drop_causes = {DropCause::transport, DropCause::queue_full,
                                           DropCause::paused,    DropCause::disk,
                                           DropCause::refused,   DropCause::stopping};

constexpr const char* to_string(DropCause cause) {
    switch (cause) {
        case DropCause::transport:
            return "transport";
        case DropCause::queue_full:
            return "queue_full";
        case DropCause::paused:
            return "paused";
        case DropCause::disk:
            return "disk";
        case DropCause::refused:
            return "refused";
        case DropCause::stopping:
            return "stopping";
    }
    return "";
}

}  // namespace pursuit::recorder
