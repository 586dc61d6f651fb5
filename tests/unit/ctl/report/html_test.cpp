// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/report/html.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string_view>

namespace pursuit::ctl {
namespace {

TEST(Html, text_is_cut_at_its_bound_and_numbers_are_short) {
    EXPECT_EQ(escape_html("abcdef", 3), "abc…");
    EXPECT_EQ(escape_html("a\xC3\xA4", 2), "a\xEF\xBF\xBD…");
    EXPECT_EQ(escape_html("µ…😀", 100), "µ…😀");
    EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN(), 2), "–");
    EXPECT_EQ(number(1.005, 1), "1.0");
    EXPECT_EQ(short_number(1'234'567), "1.23 M");
    EXPECT_EQ(coordinate(-0.0001), "0");
    EXPECT_EQ(coordinate(12.50), "12.5");
    EXPECT_EQ(coordinate(1e300), "10000000");
}

TEST(Html, base64_is_as_in_rfc_4648) {
    const auto of = [](std::string_view text) {
        return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    };
    EXPECT_EQ(of(""), "");
    EXPECT_EQ(of("f"), "Zg==");
    EXPECT_EQ(of("fo"), "Zm8=");
    EXPECT_EQ(of("foo"), "Zm9v");
    EXPECT_EQ(of("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace pursuit::ctl
