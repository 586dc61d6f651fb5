// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/grey/grey_image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>

#include "services/ctl/grey/read_exposures.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_data.hpp"

namespace pursuit::ctl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto first = std::uint8_t{0};
constexpr auto second = std::uint8_t{1};

/// Grey levels of a PNG, row by row.
struct Picture {
    unsigned width = 0;
    unsigned height = 0;
    std::vector<std::uint8_t> levels;
};

Picture decoded(png_image& png) {
    png.format = PNG_FORMAT_GRAY;
    Picture picture{png.width, png.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(png))};
    EXPECT_NE(png_image_finish_read(&png, nullptr, picture.levels.data(), 0, nullptr), 0);
    return picture;
}

TEST(GreyImage, measures_from_the_last_first_threshold_to_the_next_second_one) {
    GreyImage image({3, 1});
    image.take(std::vector<Event>{{10, 0, 0, second},  // never begun
                                  {20, 1, 0, first},
                                  {30, 1, 0, first},  // begun anew
                                  {70, 1, 0, second},
                                  {90, 1, 0, second},   // ended already
                                  {90, 2, 0, first},    // never ended
                                  {95, 3, 0, first}});  // outside
    EXPECT_THAT(image.integration_us(), ElementsAre(0, 40, 0));
    image.take(std::vector<Event>{{90, 2, 0, second}});
    EXPECT_THAT(image.integration_us(), ElementsAre(0, 40, 1));
    EXPECT_EQ(image.measured_pixels(), 2U);
}

TEST(GreyImage, is_brighter_the_shorter_the_integration_and_black_where_nothing_is_known) {
    GreyImage image({5, 1});
    EXPECT_THAT(image.levels(), ElementsAre(0, 0, 0, 0, 0));
    std::int64_t t_us = 0;
    for (std::uint16_t x = 0; x < 4; ++x) {
        image.take(std::vector<Event>{{t_us, x, 0, first}});
        t_us += 100 * (1 << x);
        image.take(std::vector<Event>{{t_us, x, 0, second}});
    }
    EXPECT_THAT(image.levels(), ElementsAre(255, 170, 86, 1, 0));  // equal ratios, equal steps
    GreyImage one({1, 1});
    one.take(std::vector<Event>{{0, 0, 0, first}, {5, 0, 0, second}});
    EXPECT_THAT(one.levels(), ElementsAre(255));
}

TEST(GreyImage, comes_out_of_its_png_as_it_is) {
    GreyImage image({7, 3});
    std::vector<Event> crossings;
    for (std::uint16_t i = 0; i < 21; ++i) {
        const auto x = static_cast<std::uint16_t>(i % 7);
        const auto y = static_cast<std::uint16_t>(i / 7);
        crossings.push_back({i * 1000, x, y, first});
        crossings.push_back({i * 1000 + 10 + 7 * i, x, y, second});
    }
    image.take(crossings);
    const auto bytes = grey_png(image);
    ASSERT_TRUE(bytes);
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&png, bytes->data(), bytes->size()), 0);
    const auto picture = decoded(png);
    EXPECT_EQ(picture.width, 7U);
    EXPECT_EQ(picture.height, 3U);
    EXPECT_EQ(picture.levels, image.levels());
}

TEST(GreyImage, of_a_file_without_measurements_is_refused) {
    const test::TemporaryFolder folder;
    const auto path = folder.file("a.txt", "0.1 1 1 1\n");
    EXPECT_THAT(grey_of_events(path, {}, 10).error().message,
                HasSubstr("a.txt: holds no exposure measurements"));
}

TEST(GreyImage, of_a_time_after_the_recording_is_refused_with_the_time_that_it_ends) {
    const test::TemporaryFolder folder;
    const auto path = folder.path("a.es");
    auto writer = sensor::create_events(path, {3, 2}, true);
    ASSERT_TRUE(writer);
    const std::vector<Event> exposures = {{10, 1, 1, first}, {70, 1, 1, second}};
    ASSERT_TRUE((*writer)->write({}, exposures));
    ASSERT_TRUE((*writer)->close());
    const auto image = grey_of_events(path, {}, 70);
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_EQ(image->measured_pixels(), 1U);
    EXPECT_TRUE(grey_of_events(path, {}, 20'070));
    EXPECT_FALSE(grey_of_events(path, {}, 20'071));
    EXPECT_THAT(grey_of_events(path, {}, 99'000'000).error().message,
                HasSubstr("a.es: ends at 0.000070 s, before 99.000000 s"));
}

/// What another program rebuilt from the same recording: each pixel drawn as 2x2, one row and one
/// column of them empty before the image.
TEST(GreyImage, of_the_real_car_agrees_with_what_another_program_rebuilt) {
    PURSUIT_DATA_OR_SKIP(recording, "car/car_atis_td_em.es");
    PURSUIT_DATA_OR_SKIP(reference, "car/car_atis_em_grey_1.95s.png");
    const auto image = grey_of_events(recording, {}, 1'950'000);
    ASSERT_TRUE(image) << image.error().message;
    ASSERT_EQ(image->geometry(), (Geometry{304, 240}));
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&png, reference.c_str()), 0);
    const auto other = decoded(png);
    ASSERT_EQ(other.width, 610U);
    ASSERT_EQ(other.height, 482U);

    const auto levels = image->levels();
    std::size_t measured = 0, only_theirs = 0, compared = 0, far = 0;
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (unsigned row = 0; row < 240; ++row) {
        for (unsigned column = 0; column < 304; ++column) {
            const int own = levels[row * 304 + column];
            const int theirs = other.levels[(2 * row + 2) * other.width + 2 * column + 2];
            measured += own > 0 ? 1U : 0U;
            only_theirs += own == 0 && theirs > 0 ? 1U : 0U;
            if (own == 0 || theirs == 0) continue;  // theirs: 0 is also its darkest level
            ++compared;
            far += std::abs(own - theirs) > 20 ? 1U : 0U;
            x += own, y += theirs;
            xx += own * own, yy += theirs * theirs, xy += own * theirs;
        }
    }
    EXPECT_EQ(only_theirs, 0U);
    EXPECT_GT(compared, 25'000U);
    EXPECT_LT(measured - compared, measured / 25);
    const auto n = static_cast<double>(compared);
    const double correlation = (xy - x * y / n) / std::sqrt((xx - x * x / n) * (yy - y * y / n));
    EXPECT_GT(correlation, 0.995);
    EXPECT_LT(static_cast<double>(far), 0.02 * n);  // the ends of the two scales differ
    std::printf(
        "%zu pixels measured, %zu compared: correlation %.5f, %zu more than 20 levels off\n",
        measured, compared, correlation, far);
}

}  // namespace
}  // namespace pursuit::ctl
