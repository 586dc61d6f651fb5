// SPDX-License-Identifier: Apache-2.0
#include "services/common/text_format.hpp"

#include <fcntl.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/stubs/strutil.h>
#include <google/protobuf/text_format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "ranges.pb.h"

namespace pursuit {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::TextFormat;

constexpr std::uintmax_t max_file_bytes = 64ULL << 20;

/// Line `index` of `text`, from 0, without white space around it and at most 80 bytes.
std::string line_of(std::string_view text, int index) {
    for (; index > 0 && !text.empty(); --index) {
        text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    }
    text = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    return std::string(text.substr(0, 80));
}

/// Keeps the first error; line and column become 1-based, as editors count. The line itself is
/// quoted, because Protobuf's message about a wrong type does not name the field.
class FirstError : public google::protobuf::io::ErrorCollector {
 public:
    FirstError(std::string name, std::string_view text) : name_(std::move(name)), text_(text) {}

    void AddError(int line, google::protobuf::io::ColumnNumber column,
                  const std::string& message) override {
        if (message_.empty()) {
            message_ = name_ + ":" + std::to_string(line + 1) + ":" + std::to_string(column + 1) +
                       ": " + message + " in: " + line_of(text_, line);
        }
    }

    const std::string& message() const { return message_; }

 private:
    std::string name_;
    std::string_view text_;
    std::string message_;
};

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
    } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_STRING && !field.is_repeated() &&
               options.HasExtension(disk::max_length)) {
        const auto length = message.GetReflection()->GetString(message, &field).size();
        if (length > options.GetExtension(disk::max_length)) {
            return "has " + std::to_string(length) + " bytes, must have at most " +
                   std::to_string(options.GetExtension(disk::max_length));
        }
    }
    return std::nullopt;
}

/// The first value of `message`, or below it, that is out of its stated range.
Result<void> check_ranges(const Message& message, const std::string& name,
                          const TextFormat::ParseInfoTree* places, const std::string& path) {
    const auto* reflection = message.GetReflection();
    std::vector<const FieldDescriptor*> fields;
    reflection->ListFields(message, &fields);
    for (const auto* field : fields) {
        const std::string field_path = path.empty() ? field->name() : path + "." + field->name();
        const int count = field->is_repeated() ? reflection->FieldSize(message, field) : 1;
        const auto where = [&](int index) {
            if (places == nullptr) return name;
            const auto place = places->GetLocation(field, index);
            return place.line < 0 ? name : name + ":" + std::to_string(place.line + 1);
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
            if (auto ok = check_ranges(nested, name, nested_places, field_path); !ok) return ok;
        }
    }
    return {};
}

Result<void> merge_text(std::string_view text, const std::string& name, Message& message) {
    FirstError errors(name, text);
    TextFormat::ParseInfoTree places;
    TextFormat::Parser parser;
    parser.RecordErrorsTo(&errors);
    parser.WriteLocationsTo(&places);
    if (!parser.MergeFromString(std::string(text), &message)) {
        return fail(errors.message().empty() ? name + ": not valid Protobuf text"
                                             : errors.message());
    }
    return check_ranges(message, name, &places, "");
}

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

/// Applies one setting to `message`, which the path so far leads to.
Result<void> apply_setting(const std::string& name, std::string_view path, const std::string& value,
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
    if (last == (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE)) {
        return fail(name + ": field \"" + part->field + "\" " +
                    (last ? "is a message, name a field of it" : "has no fields"));
    }
    if (part->index && (last || !field->is_repeated())) {
        return fail(name + ": field \"" + part->field + "\" has no numbered messages");
    }
    if (last) {
        const bool quote = field->cpp_type() == FieldDescriptor::CPPTYPE_STRING &&
                           (value.empty() || value.front() != '"');
        const std::string text = quote ? "\"" + google::protobuf::CEscape(value) + "\"" : value;
        return merge_text(part->field + ": " + text, name, message);
    }
    const auto* reflection = message.GetReflection();
    if (part->index && *part->index >= reflection->FieldSize(message, field)) {
        return fail(name + ": there are " + std::to_string(reflection->FieldSize(message, field)) +
                    " of field \"" + part->field + "\", counted from 0");
    }
    Message* nested = nullptr;
    if (part->index) {
        nested = reflection->MutableRepeatedMessage(&message, field, *part->index);
    } else if (field->is_repeated()) {
        nested = reflection->AddMessage(&message, field);
    } else {
        nested = reflection->MutableMessage(&message, field);
    }
    return apply_setting(name, path.substr(dot + 1), value, *nested);
}

std::string system_error(const std::string& path, const char* what) {
    return path + ": cannot " + what + ": " + std::strerror(errno);
}

}  // namespace

Result<void> parse_text(std::string_view text, const std::string& name, Message& message) {
    message.Clear();
    return merge_text(text, name, message);
}

Result<void> read_text_file(const std::string& path, Message& message) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) return fail(path + ": is a folder");
    std::ifstream in(path, std::ios::binary);
    if (!in) return fail(system_error(path, "open"));
    std::ostringstream text;
    const auto size = std::filesystem::file_size(path, error);
    if (!error && size > max_file_bytes) return fail(path + ": larger than 64 MiB");
    text << in.rdbuf();
    if (in.bad()) return fail(system_error(path, "read"));
    return parse_text(text.str(), path, message);
}

Result<void> apply_settings(const std::vector<std::string>& settings, Message& message) {
    for (const auto& setting : settings) {
        const std::string name = "--set " + setting;
        const auto equals = setting.find('=');
        if (equals == std::string::npos || equals == 0) {
            return fail(name + ": must be field=value");
        }
        const std::string_view path(setting.data(), equals);
        if (auto ok = apply_setting(name, path, setting.substr(equals + 1), message); !ok)
            return ok;
    }
    return {};
}

Result<void> write_text_file(const std::string& path, const Message& message) {
    std::string text;
    if (!TextFormat::PrintToString(message, &text)) return fail(path + ": cannot be printed");
    return write_file_atomically(path, text);
}

Result<void> write_file_atomically(const std::string& path, std::string_view content) {
    std::string temporary = path + ".XXXXXX";
    const int file = ::mkstemp(temporary.data());
    if (file < 0) return fail(system_error(path, "create a temporary file beside it"));
    const auto give_up = [&](const char* what) {
        auto error = fail(system_error(path, what));
        ::unlink(temporary.c_str());
        return error;
    };
    for (std::size_t written = 0; written < content.size();) {
        const auto n = ::write(file, content.data() + written, content.size() - written);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            auto error = give_up("write");
            ::close(file);
            return error;
        }
        written += static_cast<std::size_t>(n);
    }
    const mode_t mask = ::umask(0);
    ::umask(mask);
    if (::fchmod(file, 0666 & ~mask) != 0 || ::fsync(file) != 0) {
        auto error = give_up("sync");
        ::close(file);
        return error;
    }
    if (::close(file) != 0) return give_up("close");
    if (::rename(temporary.c_str(), path.c_str()) != 0) return give_up("rename");
    const auto folder = std::filesystem::path(path).parent_path();
    const int directory = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY);
    if (directory < 0) return fail(system_error(path, "open the folder of"));
    const bool synced = ::fsync(directory) == 0;
    ::close(directory);
    if (!synced) return fail(system_error(path, "sync the folder of"));
    return {};
}

}  // namespace pursuit
