// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/call_result.hpp"

namespace pursuit::tracker {

std::string_view to_string(CallStatus status) {
    switch (status) {
        case CallStatus::invalid_argument:
            return "invalid argument";
        case CallStatus::not_found:
            return "not found";
        case CallStatus::already_exists:
            return "already exists";
        case CallStatus::limit_exceeded:
            return "limit exceeded";
        case CallStatus::unsupported:
            return "unsupported";
    }
    return "unknown";
}

}  // namespace pursuit::tracker
