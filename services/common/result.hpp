// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace pursuit {

/// Why something could not be done: one sentence that names what and where.
struct Error {
    std::string message;
    /// The field of a configuration file that it is about, as "dds.domain" or "parameter[2]":
    /// whoever has read the file knows the line (FieldPlaces). Empty: none.
    std::string field = {};
};

/// A value or the reason why there is none. Errors cross module borders in this form.
template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(std::string message) {
    return tl::unexpected<Error>(Error{std::move(message)});
}

/// An error about a field of a configuration: "field dds.domain" and what is wrong with it.
inline tl::unexpected<Error> fail_field(const std::string& field, const std::string& what) {
    return tl::unexpected<Error>(Error{"field " + field + what, field});
}

}  // namespace pursuit
