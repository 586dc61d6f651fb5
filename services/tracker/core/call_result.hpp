// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace pursuit::tracker {

/// Why a call on the tracker was refused. Whatever the reason, nothing was changed.
enum class CallStatus {
    invalid_argument,  ///< A field is malformed or out of its range.
    not_found,         ///< No object, parameter or preset of that name.
    already_exists,    ///< The name or the id is taken by other content.
    limit_exceeded,    ///< A table is full.
    unsupported,       ///< Known, but not built into this version.
};

std::string_view to_string(CallStatus status);

struct CallError {
    CallStatus status;
    std::string message;  ///< One sentence that names the field and its bound; at most 511 bytes.
};

/// The result of a call on the tracker, or why it was refused.
template <class T>
using CallResult = tl::expected<T, CallError>;

inline tl::unexpected<CallError> refuse(CallStatus status, std::string message) {
    if (message.size() > 511) message.resize(511);
    return tl::unexpected<CallError>(CallError{status, std::move(message)});
}

}  // namespace pursuit::tracker
