// SPDX-License-Identifier: Apache-2.0
#include "services/common/ranges.hpp"

#include <google/protobuf/stubs/strutil.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

#include "ranges.pb.h"
#include "services/common/field_places.hpp"

namespace pursuit {
namespace {

// A name is a DDS partition, in which '*', '?' and brackets stand for others.
bool is_name_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '-';
}

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::TextFormat;

/// The value at `index` of a numeric field (index ignored where not repeated).
std::optional<double> number(const Message& message, const FieldDescriptor& field, int index) {
    const auto* r = message.GetReflection();
    const bool many = field.is_repeated();
    switch (field.cpp_type()) {
        case FieldDescriptor::CPPTYPE_INT32:
            return many ? r->GetRepeatedInt32(message, &field, index)
                        : r->GetInt32(message, &field);
        case FieldDescriptor::CPPTYPE_INT64:
            return static_cast<double>(many ? r->GetRepeatedInt64(message, &field, index)
                                            : r->GetInt64(message, &field));
        case FieldDescriptor::CPPTYPE_UINT32:
            return many ? r->GetRepeatedUInt32(message, &field, index)
                        : r->GetUInt32(message, &field);
        case FieldDescriptor::CPPTYPE_UINT64:
            return static_cast<double>(many ? r->GetRepeatedUInt64(message, &field, index)
                                            : r->GetUInt64(message, &field));
        case FieldDescriptor::CPPTYPE_FLOAT:
            return many ? r->GetRepeatedFloat(message, &field, index)
                        : r->GetFloat(message, &field);
        case FieldDescriptor::CPPTYPE_DOUBLE:
            return many ? r->GetRepeatedDouble(message, &field, index)
                        : r->GetDouble(message, &field);
        default:
            return std::nullopt;
    }
}

std::string print(double value) {
    std::ostringstream out;
    out.precision(12);
    out << value;
    return out.str();
}

/// What is wrong with one value, or nothing.
std::optional<std::string> range_error(const Message& message, const FieldDescriptor& field,
                                       int index) {
    const auto& options = field.options();
    if (const auto value = number(message, field, index)) {
        if (!std::isfinite(*value)) return "is not a finite number";
        if (options.HasExtension(disk::at_least) && *value < options.GetExtension(disk::at_least)) {
            return "is " + print(*value) + ", must be at least " +
                   print(options.GetExtension(disk::at_least));
        }
        if (options.HasExtension(disk::more_than) &&
            *value <= options.GetExtension(disk::more_than)) {
            return "is " + print(*value) + ", must be more than " +
                   print(options.GetExtension(disk::more_than));
        }
        if (options.HasExtension(disk::at_most) && *value > options.GetExtension(disk::at_most)) {
            return "is " + print(*value) + ", must be at most " +
                   print(options.GetExtension(disk::at_most));
        }
    } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_STRING && !field.is_repeated()) {
        const std::string text = message.GetReflection()->GetString(message, &field);
        if (options.HasExtension(disk::max_length) &&
            text.size() > options.GetExtension(disk::max_length)) {
            return "has " + std::to_string(text.size()) + " bytes, must have at most " +
                   std::to_string(options.GetExtension(disk::max_length));
        }
        if (options.GetExtension(disk::is_name) &&
            !std::all_of(text.begin(), text.end(), is_name_character)) {
            return "is \"" + google::protobuf::CEscape(text) +
                   "\", must be of A-Z, a-z, 0-9, '_', '.' and '-'";
        }
    }
    return std::nullopt;
}

/// As check_ranges(), for what is in the field `path`; empty: the whole.
Result<void> check_below(const Message& message, const std::string& name,
                         const TextFormat::ParseInfoTree* places, const std::string& path) {
    const auto* reflection = message.GetReflection();
    std::vector<const FieldDescriptor*> fields;
    reflection->ListFields(message, &fields);
    for (const auto* field : fields) {
        const std::string field_path = path.empty() ? field->name() : path + "." + field->name();
        const int count = field->is_repeated() ? reflection->FieldSize(message, field) : 1;
        const auto where = [&](int index) {
            if (places == nullptr) return name;
            const int line = line_in_text(*places, *field, index);
            return line < 0 ? name : name + ":" + std::to_string(line + 1);
        };
        if (field->is_repeated() && field->options().HasExtension(disk::max_length) &&
            static_cast<std::uint32_t>(count) > field->options().GetExtension(disk::max_length)) {
            return fail(where(count - 1) + ": field " + field_path + " has " +
                        std::to_string(count) + " entries, at most " +
                        std::to_string(field->options().GetExtension(disk::max_length)) +
                        " are allowed");
        }
        for (int i = 0; i < count; ++i) {
            const int index = field->is_repeated() ? i : -1;
            if (const auto error = range_error(message, *field, i)) {
                return fail(where(index) + ": field " + field_path + " " + *error);
            }
            if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) continue;
            const auto& nested = field->is_repeated()
                                     ? reflection->GetRepeatedMessage(message, field, i)
                                     : reflection->GetMessage(message, field);
            const auto* nested_places =
                places == nullptr ? nullptr : places->GetTreeForNested(field, index);
            if (auto ok = check_below(nested, name, nested_places, field_path); !ok) return ok;
        }
    }
    return {};
}

}  // namespace

Result<void> check_ranges(const Message& message, const std::string& name,
                          const TextFormat::ParseInfoTree* places) {
    return check_below(message, name, places, "");
}

}  // namespace pursuit
