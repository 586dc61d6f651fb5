// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include <map>
#include <string>

#include "services/common/result.hpp"

namespace pursuit {

/// The line, from 0, of a field in a text that was read, or of its entry `index` (-1: not
/// repeated). Entries of a list in brackets have the line of its beginning. -1: not in the text.
int line_in_text(const google::protobuf::TextFormat::ParseInfoTree& lines,
                 const google::protobuf::FieldDescriptor& field, int index);

/// Where the fields of a message come from, by their paths: "parameter[2].value" from
/// "tracker.textproto:14", "dds.domain" from "--set dds.domain=7".
class FieldPlaces {
 public:
    /// In place of what was noted of the field, and of what is in it.
    void note(const std::string& field, const std::string& place);

    /// Every field of `message`, which was read from the text called `name`.
    void note(const google::protobuf::Message& message, const std::string& name,
              const google::protobuf::TextFormat::ParseInfoTree& lines);

    /// Of the field, or of the innermost one around it of which a place is noted; empty: none.
    std::string of(std::string field) const;

    /// The error with the place of its field in front, and of no field any more; with `otherwise`
    /// in front where no place is known.
    Error located(const Error& error, const std::string& otherwise) const;

 private:
    void note_below(const google::protobuf::Message& message, const std::string& name,
                    const google::protobuf::TextFormat::ParseInfoTree& lines,
                    const std::string& above);

    std::map<std::string, std::string> places_;
};

}  // namespace pursuit
