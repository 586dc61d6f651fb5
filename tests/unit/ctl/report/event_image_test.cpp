// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/report/event_image.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <vector>

namespace pursuit::ctl {
namespace {

TEST(EventImage, is_a_picture_of_the_majority_at_each_pixel) {
    const auto png = event_png({{0, 1, 0, 1}, {0, 1, 0, 1}, {0, 1, 0, 0}, {0, 2, 1, 0}}, {4, 2});
    ASSERT_TRUE(png);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&image, png->data(), png->size()), 0);
    image.format = PNG_FORMAT_RGBA;
    ASSERT_EQ(image.width, 4U);
    ASSERT_EQ(image.height, 2U);
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
    ASSERT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
    for (std::size_t i = 0; i < 8; ++i) {
        const bool on = i == 1;
        const bool off = i == 6;
        EXPECT_EQ(pixels[4 * i + 3] > 0, on || off) << i;
        if (on) {
            EXPECT_GT(pixels[4 * i + 2], pixels[4 * i]) << "ON is not blue";
        }
        if (off) {
            EXPECT_LT(pixels[4 * i + 2], pixels[4 * i]) << "OFF is not brown";
        }
    }
    EXPECT_GT(pixels[4 * 1 + 3], pixels[4 * 6 + 3]) << "more events are not stronger";
    EXPECT_FALSE(event_png({}, {0, 5}));
}

}  // namespace
}  // namespace pursuit::ctl
