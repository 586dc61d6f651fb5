// SPDX-License-Identifier: Apache-2.0
// The filters that read files, and the chain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "services/common/text_format.hpp"
#include "services/sensor/filters/filter_chain.hpp"
#include "services/sensor/filters/lens.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/sensor/filters/random_events.hpp"

namespace pursuit::sensor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using Events = std::vector<Event>;

Result<std::unique_ptr<FilterChain>> chain_of(const std::vector<std::string>& texts,
                                              Geometry geometry = small) {
    std::vector<FilterSetting> settings;
    for (const auto& text : texts) settings.push_back(*parse_filter(text));
    return FilterChain::make(settings, geometry);
}

Events passed(FilterChain& chain, Events events, FilterCounts& counts) {
    events.resize(chain.apply(events, counts));
    return events;
}

TEST(PixelMask, drops_its_pixels_and_rectangles_and_no_others) {
    const test::TemporaryFolder folder;
    const auto file = folder.file("mask.textproto",
                                  "width: 24 height: 18 pixel { x_px: 0 y_px: 0 }\n"
                                  "pixel { x_px: 23 y_px: 17 }\n"
                                  "rectangle { x_px: 4 y_px: 2 width_px: 3 height_px: 5 }\n");
    const auto chain = chain_of({"pixel_mask file=" + file});
    ASSERT_TRUE(chain) << chain.error().message;
    FilterCounts counts{};
    auto events = random_events(4000, small, 6);
    events.push_back({events.back().t_us, 23, 17, 1});
    Events expected;
    for (const auto& event : events) {
        const bool corner = (event.x == 0 && event.y == 0) || (event.x == 23 && event.y == 17);
        const bool inside = event.x >= 4 && event.x < 7 && event.y >= 2 && event.y < 7;
        if (!corner && !inside) expected.push_back(event);
    }
    EXPECT_EQ(passed(**chain, events, counts), expected);
    EXPECT_EQ(counts[*find_filter_kind("pixel_mask")], events.size() - expected.size());
}

TEST(PixelMask, of_another_image_or_beyond_it_or_unreadable_is_refused_with_the_file) {
    const test::TemporaryFolder folder;
    const auto message_of = [&](const std::string& content) {
        const auto file = folder.file("mask.textproto", content);
        const auto chain = chain_of({"pixel_mask file=" + file});
        EXPECT_THAT(chain.error().message, HasSubstr(file));
        return chain.error().message;
    };
    EXPECT_THAT(message_of("width: 25 height: 18"), HasSubstr("25x18"));
    EXPECT_THAT(message_of("width: 24 height: 18 pixel { x_px: 24 y_px: 0 }"),
                HasSubstr("pixel[0] reaches beyond"));
    EXPECT_THAT(message_of("width: 24 height: 18\nrectangle { x_px: 23 y_px: 0 width_px: 2 "
                           "height_px: 1 }"),
                HasSubstr("rectangle[0] reaches beyond"));
    EXPECT_THAT(message_of("width: 24\nhight: 18"), HasSubstr(":2:"));
    EXPECT_THAT(chain_of({"pixel_mask file=/nowhere"}).error().message, HasSubstr("/nowhere"));
}

TEST(FilterFile, that_is_none_is_refused_by_file_line_and_column_and_nothing_of_it_is_told) {
    const test::TemporaryFolder folder;
    for (const std::string content : {"secret:x:0:0::/:/bin/sh", "width: 24\n  secret: 1",
                                      "width: secret", "width: \"secret"}) {
        const auto file = folder.file("passwd", content);
        for (const auto* filter : {"pixel_mask file=", "undistort file="}) {
            const auto chain = chain_of({filter + file});
            ASSERT_FALSE(chain) << content;
            EXPECT_THAT(chain.error().message, HasSubstr(file + ":"));
            EXPECT_THAT(chain.error().message, Not(HasSubstr("secret")));
        }
    }
    EXPECT_THAT(chain_of({"pixel_mask file=" + folder.file("passwd", "width: 24\n  secret: 1")})
                    .error()
                    .message,
                HasSubstr("passwd:2:9: is no PixelMask"));
}

/// The camera of the RPG recordings, as its calibration states it.
disk::Calibration davis() {
    disk::Calibration c;
    c.set_width(240);
    c.set_height(180);
    c.set_fx_px(199.092366542);
    c.set_fy_px(198.82882047);
    c.set_cx_px(132.192071378);
    c.set_cy_px(110.712660011);
    c.set_k1(-0.368436311798);
    c.set_k2(0.150947243557);
    c.set_p1(-0.000296130534385);
    c.set_p2(-0.000759431726241);
    return c;
}

TEST(Lens, undistorting_is_the_inverse_of_distorting_over_the_whole_image) {
    auto fisheye = davis();
    fisheye.set_lens(disk::Calibration::FISHEYE);
    fisheye.set_k1(-0.02);
    fisheye.set_k2(0.003);
    for (const auto& calibration : {davis(), fisheye}) {
        const Lens lens(calibration);
        for (int y = 0; y < 180; y += 7) {
            for (int x = 0; x < 240; x += 7) {
                const Ray seen{(x - calibration.cx_px()) / calibration.fx_px(),
                               (y - calibration.cy_px()) / calibration.fy_px()};
                const auto ray = lens.undistort(seen);
                ASSERT_TRUE(ray) << x << ", " << y;
                const auto again = lens.distort(*ray);
                EXPECT_NEAR(again.x, seen.x, 1e-8);
                EXPECT_NEAR(again.y, seen.y, 1e-8);
            }
        }
    }
}

TEST(Lens, without_coefficients_changes_nothing_and_beyond_its_fold_sees_nothing) {
    disk::Calibration plain;
    const auto same = Lens(plain).undistort({0.3, -0.2});
    ASSERT_TRUE(same);
    EXPECT_DOUBLE_EQ(same->x, 0.3);
    plain.set_k1(-0.4);  // r(1 - 0.4 r²) is at most 0.609: nothing is seen farther out
    EXPECT_TRUE(Lens(plain).undistort({0.6, 0}));
    EXPECT_FALSE(Lens(plain).undistort({0.65, 0}));
    disk::Calibration fisheye;
    fisheye.set_lens(disk::Calibration::FISHEYE);
    EXPECT_NEAR(Lens(fisheye).undistort({0.5, 0})->x, std::tan(0.5), 1e-8);
    EXPECT_FALSE(Lens(fisheye).undistort({1.6, 0}));  // beyond a right angle
}

TEST(Undistort, moves_each_pixel_to_where_the_lens_would_have_bent_it_from) {
    const test::TemporaryFolder folder;
    const auto calibration = davis();
    const auto path = folder.path("lens.textproto");
    ASSERT_TRUE(write_text_file(path, calibration));
    const auto chain = chain_of({"undistort file=" + path}, {240, 180});
    ASSERT_TRUE(chain) << chain.error().message;
    EXPECT_EQ((*chain)->geometry(), (Geometry{240, 180}));
    FilterCounts counts{};
    const Lens lens(calibration);
    std::uint64_t kept = 0;
    for (int y = 0; y < 180; ++y) {
        for (int x = 0; x < 240; ++x) {
            std::array event{
                Event{5, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), 1}};
            if ((*chain)->apply(event, counts) == 0) continue;
            ++kept;
            // Bending the undistorted pixel must lead back to within its rounding, stretched.
            const auto seen =
                lens.distort({(event[0].x - calibration.cx_px()) / calibration.fx_px(),
                              (event[0].y - calibration.cy_px()) / calibration.fy_px()});
            ASSERT_NEAR(seen.x * calibration.fx_px() + calibration.cx_px(), x, 0.55);
            ASSERT_NEAR(seen.y * calibration.fy_px() + calibration.cy_px(), y, 0.55);
        }
    }
    EXPECT_EQ(kept + counts[*find_filter_kind("undistort")], 240U * 180U);
    EXPECT_GT(kept, 240U * 180U * 7 / 10);
    EXPECT_LT(kept, 240U * 180U);  // this lens is a barrel: its corners lie outside
}

TEST(Undistort, gives_the_image_that_the_calibration_asks_for) {
    const test::TemporaryFolder folder;
    auto calibration = davis();
    calibration.mutable_output()->set_width(400);
    calibration.mutable_output()->set_height(300);
    calibration.mutable_output()->set_cx_px(212);
    calibration.mutable_output()->set_cy_px(170);
    const auto path = folder.path("lens.textproto");
    ASSERT_TRUE(write_text_file(path, calibration));
    const auto chain = chain_of({"undistort file=" + path, "geometry transpose=1"}, {240, 180});
    ASSERT_TRUE(chain) << chain.error().message;
    EXPECT_EQ((*chain)->geometry(), (Geometry{300, 400}));
    FilterCounts counts{};
    Events corners{{1, 0, 0, 1}, {1, 239, 0, 1}, {1, 0, 179, 1}, {1, 239, 179, 1}};
    EXPECT_EQ((*chain)->apply(corners, counts), 4U);  // now there is room for them
    EXPECT_THAT(chain_of({"undistort file=" + path}).error().message, HasSubstr("240x180"));
}

TEST(FilterChain, of_nothing_passes_everything) {
    const auto chain = chain_of({});
    FilterCounts counts{};
    const auto events = random_events(100, small, 1);
    EXPECT_EQ(passed(**chain, events, counts), events);
    EXPECT_EQ((*chain)->geometry(), small);
}

TEST(FilterChain, applies_its_filters_in_order_and_counts_what_each_drops) {
    // The region is of the turned image: 18 wide, 24 high.
    const auto chain = chain_of({"polarity keep=1", "geometry rotate_deg=90",
                                 "region_of_interest y_px=20", "polarity keep=1 invert=1"});
    ASSERT_TRUE(chain) << chain.error().message;
    EXPECT_EQ((*chain)->geometry(), (Geometry{18, 24}));
    const auto events = random_events(3000, small, 9);
    Events expected;
    std::uint64_t off = 0;
    for (const auto& event : events) {
        off += event.polarity == 0 ? 1U : 0U;
        if (event.polarity == 1 && event.x >= 20) {
            expected.push_back({event.t_us, static_cast<std::uint16_t>(17 - event.y), event.x, 0});
        }
    }
    FilterCounts counts{};
    EXPECT_EQ(passed(**chain, events, counts), expected);
    EXPECT_EQ(counts[*find_filter_kind("polarity")], off);
    EXPECT_EQ(counts[*find_filter_kind("region_of_interest")],
              events.size() - off - expected.size());
    EXPECT_EQ(counts[*find_filter_kind("geometry")], 0U);
}

TEST(FilterChain, exposures_go_only_through_filters_that_look_at_pixels_alone) {
    const auto chain = chain_of({"refractory period_us=1000000", "polarity keep=0",
                                 "region_of_interest width_px=12", "geometry flip_x=1"});
    Events exposures{{1, 3, 3, 0}, {2, 3, 3, 1}, {3, 20, 3, 0}};
    exposures.resize((*chain)->apply_to_exposures(exposures));
    EXPECT_THAT(exposures, ElementsAre(Event{1, 20, 3, 0}, Event{2, 20, 3, 1}));
}

TEST(FilterChain, names_the_filter_that_does_not_fit_and_what_it_must_be) {
    EXPECT_THAT(chain_of({"polarity", "refractory period_us=0"}).error().message,
                HasSubstr("filter[1] refractory: parameter period_us is 0, must be"));
    // What the first filter makes of the image is what the second has to fit.
    EXPECT_FALSE(chain_of({"geometry transpose=1", "region_of_interest x_px=20"}));
    EXPECT_TRUE(chain_of({"region_of_interest x_px=20", "geometry transpose=1"}));
    EXPECT_THAT(chain_of(std::vector<std::string>(17, "polarity")).error().message,
                HasSubstr("17 entries, at most 16"));
    EXPECT_TRUE(chain_of(std::vector<std::string>(16, "polarity")));
}

}  // namespace
}  // namespace pursuit::sensor
