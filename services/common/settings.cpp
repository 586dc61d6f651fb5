// SPDX-License-Identifier: Apache-2.0
#include "services/common/settings.hpp"

#include <google/protobuf/stubs/strutil.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "services/common/text_format.hpp"

namespace pursuit {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// "name" or "name[index]".
struct PathPart {
    std::string field;
    std::optional<int> index;
};

std::optional<PathPart> parse_part(const std::string& text) {
    const auto bracket = text.find('[');
    if (bracket == std::string::npos) return PathPart{text, std::nullopt};
    if (text.back() != ']') return std::nullopt;
    const char* last = text.data() + text.size() - 1;
    int index = 0;
    const auto [end, error] = std::from_chars(text.data() + bracket + 1, last, index);
    if (error != std::errc() || end != last || index < 0) return std::nullopt;
    return PathPart{text.substr(0, bracket), index};
}

/// The path of `field` below `above`; of a repeated field that of the entry `index`.
std::string path_of(const std::string& above, const FieldDescriptor& field, int index) {
    return (above.empty() ? "" : above + ".") + field.name() +
           (field.is_repeated() ? "[" + std::to_string(index) + "]" : "");
}

/// Applies one setting to `message`, which the path `above` leads to; gives the path of what it has
/// set.
Result<std::string> apply_setting(const std::string& name, std::string_view path,
                                  const std::string& value, const std::string& above,
                                  Message& message) {
    const auto dot = std::min(path.find('.'), path.size());
    const auto part = parse_part(std::string(path.substr(0, dot)));
    const auto& type = *message.GetDescriptor();
    if (!part) {
        return fail(name + ": \"" + std::string(path.substr(0, dot)) + "\" is not field[number]");
    }
    const auto* field = type.FindFieldByName(part->field);
    if (field == nullptr) {
        return fail(name + ": " + type.name() + " has no field \"" + part->field + "\"");
    }
    const bool last = dot == path.size();
    const auto* reflection = message.GetReflection();
    const int size = field->is_repeated() ? reflection->FieldSize(message, field) : 0;
    const auto merge = [&](const std::string& text) -> Result<std::string> {
        if (auto ok = merge_text(text, name, message); !ok) return tl::unexpected(ok.error());
        return path_of(above, *field, size);
    };
    const bool is_whole = last && !part->index && !value.empty() && value.front() == '{';
    if (is_whole && field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
        return merge(part->field + " " + value);
    }
    if (last == (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE)) {
        return fail(
            name + ": field \"" + part->field + "\" " +
            (last ? "is a message: name a field of it, or give it as {…}" : "has no fields"));
    }
    if (part->index && (last || !field->is_repeated())) {
        return fail(name + ": field \"" + part->field + "\" has no numbered messages");
    }
    if (last) {
        const bool quote = field->cpp_type() == FieldDescriptor::CPPTYPE_STRING &&
                           (value.empty() || value.front() != '"');
        const std::string text = quote ? "\"" + google::protobuf::CEscape(value) + "\"" : value;
        return merge(part->field + ": " + text);
    }
    if (part->index && *part->index >= size) {
        return fail(name + ": there are " + std::to_string(size) + " of field \"" + part->field +
                    "\", counted from 0");
    }
    Message* nested = nullptr;
    if (part->index) {
        nested = reflection->MutableRepeatedMessage(&message, field, *part->index);
    } else if (field->is_repeated()) {
        nested = reflection->AddMessage(&message, field);
    } else {
        nested = reflection->MutableMessage(&message, field);
    }
    return apply_setting(name, path.substr(dot + 1), value,
                         path_of(above, *field, part->index.value_or(size)), *nested);
}

}  // namespace

Result<void> apply_settings(const std::vector<std::string>& settings, Message& message,
                            FieldPlaces* places) {
    for (const auto& setting : settings) {
        const std::string name = "--set " + setting;
        const auto equals = setting.find('=');
        if (equals == std::string::npos || equals == 0) {
            return fail(name + ": must be field=value");
        }
        const std::string_view path(setting.data(), equals);
        const auto field = apply_setting(name, path, setting.substr(equals + 1), "", message);
        if (!field) return tl::unexpected(field.error());
        if (places != nullptr) places->note(*field, name);
    }
    return {};
}

}  // namespace pursuit
