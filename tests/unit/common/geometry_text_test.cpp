// SPDX-License-Identifier: Apache-2.0
#include "services/common/geometry_text.hpp"

#include <gtest/gtest.h>

namespace pursuit {
namespace {

TEST(GeometryText, is_read_up_to_what_a_packet_can_hold) {
    EXPECT_EQ(parse_geometry("640x480"), (Geometry{640, 480}));
    EXPECT_EQ(parse_geometry("1x1"), (Geometry{1, 1}));
    EXPECT_EQ(parse_geometry("65535x32768"), (Geometry{65535, 32768}));
}

TEST(GeometryText, of_anything_else_is_nothing) {
    for (const auto* text :
         {"", "640", "640x", "x480", "640X480", "640x480 ", " 640x480", "640x480x2", "-640x480",
          "0x480", "640x0", "65536x480", "640x32769", "640x65535"}) {
        EXPECT_FALSE(parse_geometry(text)) << '"' << text << '"';
    }
}

}  // namespace
}  // namespace pursuit
