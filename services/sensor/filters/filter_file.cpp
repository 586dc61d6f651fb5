// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filters/filter_file.hpp"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include "services/common/ranges.hpp"
#include "services/common/small_file.hpp"

namespace pursuit::sensor {
namespace {

using google::protobuf::TextFormat;

constexpr std::size_t most_mib = 64;

/// Keeps where the first error is, 1-based; not Protobuf's message, which quotes the text.
class FirstPlace : public google::protobuf::io::ErrorCollector {
 public:
    void AddError(int line, google::protobuf::io::ColumnNumber column,
                  const std::string& /*message*/) override {
        if (!place_.empty()) return;
        place_ = ":" + std::to_string(line + 1) + ":" + std::to_string(column + 1);
    }

    const std::string& place() const { return place_; }

 private:
    std::string place_;
};

}  // namespace

Result<void> read_filter_file(const std::string& path, google::protobuf::Message& message) {
    const auto text = read_small_file(path, most_mib);
    if (!text) return tl::unexpected(text.error());
    FirstPlace error;
    TextFormat::ParseInfoTree places;
    TextFormat::Parser parser;
    parser.RecordErrorsTo(&error);
    parser.WriteLocationsTo(&places);
    if (!parser.ParseFromString(*text, &message)) {
        return fail(path + error.place() + ": is no " + message.GetDescriptor()->name() +
                    " as idl/filters.proto has it");
    }
    return check_ranges(message, path, &places);
}

}  // namespace pursuit::sensor
