// SPDX-License-Identifier: Apache-2.0
#include "services/common/field_places.hpp"

#include <vector>

namespace pursuit {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::TextFormat;

}  // namespace

int line_in_text(const TextFormat::ParseInfoTree& lines, const FieldDescriptor& field, int index) {
    const int line = lines.GetLocation(&field, index).line;
    // Of a list in brackets Protobuf notes the beginning alone.
    return line < 0 && index > 0 ? lines.GetLocation(&field, 0).line : line;
}

void FieldPlaces::note(const std::string& field, const std::string& place) {
    const std::string below = field + ".";
    auto next = places_.lower_bound(below);
    while (next != places_.end() && next->first.starts_with(below)) next = places_.erase(next);
    places_[field] = place;
}

void FieldPlaces::note(const Message& message, const std::string& name,
                       const TextFormat::ParseInfoTree& lines) {
    note_below(message, name, lines, "");
}

void FieldPlaces::note_below(const Message& message, const std::string& name,
                             const TextFormat::ParseInfoTree& lines, const std::string& above) {
    const auto* reflection = message.GetReflection();
    std::vector<const FieldDescriptor*> fields;
    reflection->ListFields(message, &fields);
    for (const auto* field : fields) {
        const bool many = field->is_repeated();
        const int count = many ? reflection->FieldSize(message, field) : 1;
        for (int i = 0; i < count; ++i) {
            const std::string path =
                above + field->name() + (many ? "[" + std::to_string(i) + "]" : "");
            const int index = many ? i : -1;
            if (const int line = line_in_text(lines, *field, index); line >= 0) {
                note(path, name + ":" + std::to_string(line + 1));
            }
            if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) continue;
            if (const auto* nested = lines.GetTreeForNested(field, index)) {
                note_below(many ? reflection->GetRepeatedMessage(message, field, i)
                                : reflection->GetMessage(message, field),
                           name, *nested, path + ".");
            }
        }
    }
}

std::string FieldPlaces::of(std::string field) const {
    for (;;) {
        if (const auto found = places_.find(field); found != places_.end()) return found->second;
        const auto end = field.find_last_of(".[");
        if (end == std::string::npos) return "";
        field.resize(end);
    }
}

Error FieldPlaces::located(const Error& error, const std::string& otherwise) const {
    auto place = error.field.empty() ? "" : of(error.field);
    if (place.empty()) place = otherwise;
    return {(place.empty() ? "" : place + ": ") + error.message};
}

}  // namespace pursuit
