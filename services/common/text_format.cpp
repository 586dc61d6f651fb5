// SPDX-License-Identifier: Apache-2.0
#include "services/common/text_format.hpp"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "services/common/atomic_file.hpp"
#include "services/common/ranges.hpp"
#include "services/common/small_file.hpp"

namespace pursuit {
namespace {

using google::protobuf::Message;
using google::protobuf::TextFormat;

constexpr std::size_t max_file_mib = 64;

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
/// quoted where it may be, because Protobuf's message about a wrong type does not name the field.
class FirstError : public google::protobuf::io::ErrorCollector {
 public:
    FirstError(std::string name, std::string_view text, const Message& wanted, Quoting quoting)
        : name_(std::move(name)),
          text_(text),
          wanted_(wanted.GetDescriptor()->name()),
          quoting_(quoting) {}

    void AddError(int line, google::protobuf::io::ColumnNumber column,
                  const std::string& message) override {
        if (!message_.empty()) return;
        message_ =
            name_ + ":" + std::to_string(line + 1) + ":" + std::to_string(column + 1) + ": " +
            (quoting_ == Quoting::line ? message + " in: " + line_of(text_, line)
                                       : "is no " + wanted_);  // Protobuf's message quotes as well.
    }

    const std::string& message() const { return message_; }

 private:
    std::string name_;
    std::string_view text_;
    std::string wanted_;
    Quoting quoting_;
    std::string message_;
};

/// Reads what there is: fields may be missing, but none is given twice that is not repeated.
Result<void> parse_partly(std::string_view text, const std::string& name, Message& message,
                          TextFormat::ParseInfoTree& lines, Quoting quoting = Quoting::line) {
    FirstError errors(name, text, message, quoting);
    TextFormat::Parser parser;
    parser.RecordErrorsTo(&errors);
    parser.WriteLocationsTo(&lines);
    parser.AllowPartialMessage(true);  // Of what is missing Protobuf knows no line.
    if (parser.ParseFromString(std::string(text), &message)) return {};
    return fail(errors.message().empty() ? name + ": not valid Protobuf text" : errors.message());
}

/// The first required field that is not there.
std::optional<std::string> missing_field(const Message& message) {
    if (message.IsInitialized()) return std::nullopt;
    std::vector<std::string> missing;
    message.FindInitializationErrors(&missing);
    return missing.front();
}

}  // namespace

Result<void> merge_text(std::string_view text, const std::string& name, Message& message) {
    const std::unique_ptr<Message> added(message.New());
    TextFormat::ParseInfoTree lines;
    if (auto ok = parse_partly(text, name, *added, lines); !ok) return ok;
    message.MergeFrom(*added);
    if (const auto field = missing_field(message)) {
        return fail(name + ": field " + *field + " is missing");
    }
    return check_ranges(message, name, nullptr);
}

Result<void> parse_text(std::string_view text, const std::string& name, Message& message,
                        FieldPlaces* places, Quoting quoting) {
    TextFormat::ParseInfoTree lines;
    if (auto ok = parse_partly(text, name, message, lines, quoting); !ok) return ok;
    if (const auto field = missing_field(message)) {
        FieldPlaces read;
        read.note(message, name, lines);
        return tl::unexpected(read.located({"field " + *field + " is missing", *field}, name));
    }
    if (places != nullptr) places->note(message, name, lines);
    return check_ranges(message, name, &lines);
}

Result<void> read_text_file(const std::string& path, Message& message, FieldPlaces* places,
                            Quoting quoting) {
    const auto text = read_small_file(path, max_file_mib);
    if (!text) return tl::unexpected(text.error());
    return parse_text(*text, path, message, places, quoting);
}

Result<void> write_text_file(const std::string& path, const Message& message) {
    std::string text;
    if (!TextFormat::PrintToString(message, &text)) return fail(path + ": cannot be printed");
    return write_output(path, text);
}

}  // namespace pursuit
