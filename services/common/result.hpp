// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace pursuit {

/// Why something could not be done: one sentence that names what and where.
struct Error {
    std::string message;
};

/// A value or the reason why there is none. Errors cross module borders in this form.
template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(std::string message) {
    return tl::unexpected<Error>(Error{std::move(message)});
}

}  // namespace pursuit
