// SPDX-License-Identifier: Apache-2.0
// deploy/config/ is the documentation of the configuration: it must name every key.
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "config.pb.h"
#include "services/common/text_format.hpp"

namespace pursuit {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

std::string value_text(const Message& message, const FieldDescriptor& field) {
    std::string text;
    google::protobuf::TextFormat::PrintFieldValueToString(message, &field, -1, &text);
    return text;
}

/// Every scalar with a stated default is set to it; everything else is at least named in a comment.
void expect_every_key(const Message& sample, const std::string& text, const Message& defaults) {
    const auto* type = sample.GetDescriptor();
    for (int i = 0; i < type->field_count(); ++i) {
        const auto* field = type->field(i);
        SCOPED_TRACE(field->full_name());
        EXPECT_NE(text.find(field->name() + (field->message_type() != nullptr ? " {" : ": ")),
                  std::string::npos);
        if (field->is_repeated()) continue;
        if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
            expect_every_key(sample.GetReflection()->GetMessage(sample, field), text,
                             defaults.GetReflection()->GetMessage(defaults, field));
        } else if (field->has_default_value()) {
            EXPECT_TRUE(sample.GetReflection()->HasField(sample, field));
            EXPECT_EQ(value_text(sample, *field), value_text(defaults, *field));
        }
    }
}

template <class Config>
void expect_complete(const std::string& name) {
    const std::string path = PURSUIT_SOURCE_DIR "/deploy/config/" + name;
    Config sample;
    const auto read = read_text_file(path, sample);
    ASSERT_TRUE(read) << read.error().message;
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    expect_every_key(sample, text.str(), Config());
}

TEST(SampleConfiguration, of_the_sensor_has_every_key_at_its_default) {
    expect_complete<disk::SensorConfig>("sensor.textproto");
}
TEST(SampleConfiguration, of_the_tracker_has_every_key_at_its_default) {
    expect_complete<disk::TrackerConfig>("tracker.textproto");
}
TEST(SampleConfiguration, of_the_recorder_has_every_key_at_its_default) {
    expect_complete<disk::RecorderConfig>("recorder.textproto");
}

}  // namespace
}  // namespace pursuit
