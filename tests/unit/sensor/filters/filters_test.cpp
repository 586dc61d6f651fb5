// SPDX-License-Identifier: Apache-2.0
// Each filter against a plain restatement of its rule that looks at the whole stream for each
// event.
#include "services/sensor/filters/filters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "tests/unit/sensor/filters/random_events.hpp"

namespace pursuit::sensor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Events = std::vector<Event>;

std::unique_ptr<Filter> made(const std::string& text, Geometry geometry = small) {
    auto filter = make_filter(*parse_filter(text), geometry);
    EXPECT_TRUE(filter) << filter.error().message;
    return std::move(*filter);
}

/// What passes, given in spans of at most `at_a_time`.
Events passed(Filter& filter, Events events, std::size_t at_a_time) {
    Events all;
    for (std::size_t i = 0; i < events.size(); i += at_a_time) {
        const auto span = std::span(events).subspan(i, std::min(at_a_time, events.size() - i));
        const auto kept = span.first(filter.apply(span));
        all.insert(all.end(), kept.begin(), kept.end());
    }
    return all;
}

/// Whether event i of a stream passes.
using Rule = std::function<bool(const Events&, std::size_t)>;

/// Streams from dense to sparse (the last is 7 hours), cut differently: all decide as the rule
/// does.
void expect_rule(const std::string& text, const Rule& rule, Geometry geometry = small) {
    for (const int mean_step_us : {1, 20, 400, 10'000'000}) {
        for (unsigned seed = 1; seed <= 3; ++seed) {
            const auto events = random_events(2500, geometry, seed, mean_step_us);
            Events expected;
            for (std::size_t i = 0; i < events.size(); ++i) {
                if (rule(events, i)) expected.push_back(events[i]);
            }
            for (const std::size_t at_a_time : {1, 7, 2500}) {
                EXPECT_EQ(passed(*made(text, geometry), events, at_a_time), expected)
                    << text << ", step " << mean_step_us << " us, seed " << seed << ", "
                    << at_a_time << " at a time";
            }
        }
    }
}

TEST(Filters, give_nothing_for_nothing_and_keep_time_and_order) {
    for (const auto& kind : filter_kinds()) {
        if (kind.takes_file) continue;
        const auto filter = made(std::string(kind.name));
        EXPECT_EQ(filter->apply({}), 0U) << kind.name;
        const auto kept = passed(*filter, random_events(1000, small, 5), 100);
        EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end(), [](const auto& a, const auto& b) {
            return a.t_us < b.t_us;
        })) << kind.name;
    }
}

TEST(RegionOfInterest, keeps_its_rectangle_with_its_first_and_without_its_end) {
    expect_rule("region_of_interest x_px=3 y_px=5 width_px=10 height_px=4",
                [](const Events& events, std::size_t i) {
                    const auto [t, x, y, p] = events[i];
                    return x >= 3 && x <= 12 && y >= 5 && y <= 8;
                });
    expect_rule("region_of_interest x_px=3 y_px=5 width_px=10 height_px=4 outside=1",
                [](const Events& events, std::size_t i) {
                    const auto [t, x, y, p] = events[i];
                    return x < 3 || x > 12 || y < 5 || y > 8;
                });
    expect_rule("region_of_interest", [](const Events&, std::size_t) { return true; });
}

TEST(RegionOfInterest, that_begins_outside_the_image_is_refused_with_the_bound) {
    const auto refused = make_filter(*parse_filter("region_of_interest x_px=24"), small);
    EXPECT_THAT(refused.error().message, HasSubstr("x_px is 24, must be less than 24"));
    EXPECT_TRUE(make_filter(*parse_filter("region_of_interest x_px=23 y_px=17"), small));
    EXPECT_FALSE(make_filter(*parse_filter("region_of_interest y_px=18"), small));
}

/// The rule has memory: what passed is kept beside, in a map by pixel (and polarity).
TEST(Refractory, passes_a_pixel_again_when_the_period_is_over_not_before) {
    for (const bool by_polarity : {false, true}) {
        for (const std::int64_t period_us : {1, 100, 3000, 1'000'000'000}) {
            std::map<std::array<int, 3>, std::int64_t> passed_us;
            expect_rule("refractory period_us=" + std::to_string(period_us) +
                            " by_polarity=" + std::to_string(by_polarity),
                        [&](const Events& events, std::size_t i) {
                            if (i == 0) passed_us.clear();
                            const auto [t_us, x, y, p] = events[i];
                            const std::array pixel{int{x}, int{y}, by_polarity ? int{p} : 0};
                            const auto last = passed_us.find(pixel);
                            if (last != passed_us.end() && t_us < last->second + period_us) {
                                return false;
                            }
                            passed_us[pixel] = t_us;
                            return true;
                        });
        }
    }
}

TEST(Refractory, measures_from_the_last_event_that_passed) {
    const Events events{
        {0, 1, 1, 1}, {60, 1, 1, 1}, {100, 1, 1, 1}, {199, 1, 1, 0}, {200, 1, 1, 0}};
    EXPECT_THAT(passed(*made("refractory period_us=100"), events, 9),
                ElementsAre(events[0], events[2], events[4]));
}

TEST(BackgroundActivity, counts_the_pixels_around_that_fired_within_the_window) {
    for (const bool same_polarity : {false, true}) {
        for (const auto& [radius, support, window_us] : {std::array{1, 1, 100},
                                                         {1, 3, 2000},
                                                         {2, 1, 500},
                                                         {3, 6, 400},
                                                         {1, 8, 20000},
                                                         {2, 3, 1'000'000'000}}) {
            const std::string text = "background_activity window_us=" + std::to_string(window_us) +
                                     " radius_px=" + std::to_string(radius) +
                                     " support=" + std::to_string(support) +
                                     " same_polarity=" + std::to_string(same_polarity);
            const auto rule = [&, r = radius, s = support, w = window_us](const Events& events,
                                                                          std::size_t i) {
                const auto& event = events[i];
                std::map<std::array<int, 2>, bool> active;
                for (std::size_t j = i; j-- > 0 && events[j].t_us >= event.t_us - w;) {
                    const auto& other = events[j];
                    const bool same = other.x == event.x && other.y == event.y;
                    if (std::abs(other.x - event.x) <= r && std::abs(other.y - event.y) <= r &&
                        !same && (!same_polarity || other.polarity == event.polarity)) {
                        active[{other.x, other.y}] = true;
                    }
                }
                return static_cast<int>(active.size()) >= s;
            };
            expect_rule(text, rule);
        }
    }
}

TEST(BackgroundActivity, refuses_more_support_than_there_are_neighbours) {
    const auto refused = make_filter(*parse_filter("background_activity support=9"), small);
    EXPECT_THAT(refused.error().message, HasSubstr("support is 9, must be at most 8"));
    EXPECT_TRUE(make_filter(*parse_filter("background_activity support=24 radius_px=2"), small));
}

TEST(Polarity, keeps_one_of_the_two_and_exchanges_them) {
    const Events events{{1, 0, 0, 0}, {2, 1, 0, 1}, {2, 2, 0, 1}};
    EXPECT_EQ(passed(*made("polarity"), events, 9), events);
    EXPECT_THAT(passed(*made("polarity keep=0"), events, 9), ElementsAre(events[0]));
    EXPECT_THAT(passed(*made("polarity keep=1"), events, 9), ElementsAre(events[1], events[2]));
    EXPECT_THAT(passed(*made("polarity keep=1 invert=1"), events, 1),
                ElementsAre(Event{2, 1, 0, 0}, Event{2, 2, 0, 0}));
}

/// Counts of a window by pixel, found by walking all events for each question.
int count_in_window(const Events& events, std::int64_t window, std::int64_t window_us, int x,
                    int y) {
    const auto begin_us = events.front().t_us + window * window_us;
    return static_cast<int>(std::count_if(events.begin(), events.end(), [&](const Event& event) {
        return event.t_us >= begin_us && event.t_us < begin_us + window_us && event.x == x &&
               event.y == y;
    }));
}

TEST(HotPixel, drops_in_a_window_what_stood_out_in_the_one_before) {
    constexpr std::int64_t window_us = 10'000;
    std::mt19937 random(3);
    auto events = random_events(1500, small, 8, 50);
    // Pixels that fire for a while at a rate of their own: in a corner, at an edge, two together.
    const std::array<std::array<std::uint16_t, 2>, 4> hot{{{0, 0}, {23, 9}, {10, 10}, {11, 10}}};
    const auto first_us = events.front().t_us;
    for (const auto& [x, y] : hot) {
        for (std::int64_t t_us = first_us + 100; t_us < first_us + 45'000; t_us += 150 + x) {
            events.push_back({t_us + static_cast<std::int64_t>(random() % 10), x, y, 1});
        }
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const auto& a, const auto& b) { return a.t_us < b.t_us; });
    Events expected;
    for (const auto& event : events) {
        const auto window = (event.t_us - events.front().t_us) / window_us;
        bool is_hot = false;
        if (window > 0) {
            const int own = count_in_window(events, window - 1, window_us, event.x, event.y);
            int sum = 0, neighbours = 0;
            for (int y = 0; y < small.height; ++y) {
                for (int x = 0; x < small.width; ++x) {
                    const int away = std::max(std::abs(x - event.x), std::abs(y - event.y));
                    if (away != 1) continue;
                    ++neighbours;
                    sum += count_in_window(events, window - 1, window_us, x, y);
                }
            }
            is_hot = own >= 20 && own * neighbours >= 4 * sum;  // 2000 Hz over 10 ms
        }
        if (!is_hot) expected.push_back(event);
    }
    ASSERT_LT(expected.size() + 200, events.size());
    for (const std::size_t at_a_time : {1, 13, 100'000}) {
        const auto filter = made("hot_pixel window_ms=10 rate_hz=2000 ratio=4");
        EXPECT_EQ(passed(*filter, events, at_a_time), expected);
    }
}

TEST(HotPixel, frees_every_pixel_after_a_window_without_events) {
    Events events;
    for (std::int64_t t_us = 0; t_us < 20'000; t_us += 100) events.push_back({t_us, 5, 5, 1});
    events.push_back({45'000, 5, 5, 1});
    const auto filter = made("hot_pixel window_ms=10 rate_hz=1000 ratio=2");
    const auto kept = passed(*filter, events, 50);
    ASSERT_EQ(kept.size(), 101U);  // the first window, and the event after the silence
    EXPECT_EQ(kept.back(), events.back());
}

TEST(RateControl, never_passes_more_in_a_window_than_the_limit_and_all_below_it) {
    for (const int mean_step_us : {1, 5, 30}) {
        const auto events = random_events(5000, small, 4, mean_step_us);
        const auto begin_us = events.front().t_us;
        const auto windows = [&](const Events& all) {
            std::map<std::int64_t, int> counts;
            for (const auto& event : all) ++counts[(event.t_us - begin_us) / 1000];
            return counts;
        };
        const auto kept =
            passed(*made("rate_control max_rate_hz=100000 window_us=1000"), events, 61);
        EXPECT_EQ(passed(*made("rate_control max_rate_hz=100000 window_us=1000"), events, 1), kept);
        const auto before = windows(events);
        auto after = windows(kept);
        for (const auto& [window, count] : before) {
            EXPECT_LE(after[window], 100);
            const auto previous = before.find(window - 1);
            const bool thinned = previous != before.end() && previous->second > 100;
            // As many as the share of the window before lets through, unless that is all.
            const int share = thinned ? count * 100 / previous->second : count;
            EXPECT_EQ(after[window], std::min(share, 100));
        }
    }
}

TEST(RateControl, thins_evenly_over_the_window) {
    Events events;
    for (std::int64_t t_us = 0; t_us < 3000; ++t_us) events.push_back({t_us, 0, 0, 1});
    const auto kept = passed(*made("rate_control max_rate_hz=250000 window_us=1000"), events, 100);
    ASSERT_EQ(kept.size(), 750U);
    EXPECT_EQ(kept[249].t_us, 249);  // the first window was not foreseen
    for (std::size_t i = 251; i < kept.size(); ++i) {
        EXPECT_EQ(kept[i].t_us - kept[i - 1].t_us, 4);
    }
}

TEST(RateControl, refuses_a_limit_of_less_than_one_event_a_window) {
    const auto refused =
        make_filter(*parse_filter("rate_control max_rate_hz=999 window_us=1000"), small);
    EXPECT_THAT(refused.error().message, HasSubstr("max_rate_hz is 999, must be at least 1000"));
}

/// Where a pixel of a 4x3 image goes: two corners tell any of the eight orientations.
void expect_turn(const std::string& text, Geometry output, Event top_left, Event second) {
    const auto filter = made("geometry " + text, {4, 3});
    EXPECT_EQ(filter->geometry(), output) << text;
    EXPECT_THAT(passed(*filter, {{1, 0, 0, 1}, {1, 1, 0, 1}}, 2), ElementsAre(top_left, second))
        << text;
}

TEST(Turn, lays_the_image_in_each_of_its_eight_ways) {
    expect_turn("", {4, 3}, {1, 0, 0, 1}, {1, 1, 0, 1});
    expect_turn("flip_x=1", {4, 3}, {1, 3, 0, 1}, {1, 2, 0, 1});
    expect_turn("flip_y=1", {4, 3}, {1, 0, 2, 1}, {1, 1, 2, 1});
    expect_turn("rotate_deg=180", {4, 3}, {1, 3, 2, 1}, {1, 2, 2, 1});
    expect_turn("transpose=1", {3, 4}, {1, 0, 0, 1}, {1, 0, 1, 1});
    // Clockwise: the top-left corner comes to the top right, its right neighbour below it.
    expect_turn("rotate_deg=90", {3, 4}, {1, 2, 0, 1}, {1, 2, 1, 1});
    expect_turn("rotate_deg=270", {3, 4}, {1, 0, 3, 1}, {1, 0, 2, 1});
    expect_turn("transpose=1 rotate_deg=180", {3, 4}, {1, 2, 3, 1}, {1, 2, 2, 1});
}

TEST(Turn, keeps_every_event_inside_its_image_and_is_undone_by_its_opposite) {
    const auto events = random_events(2000, small, 2);
    for (const auto& [there, back] :
         std::map<std::string, std::string>{{"rotate_deg=90", "rotate_deg=270"},
                                            {"rotate_deg=90 flip_x=1", "transpose=1"},
                                            {"transpose=1", "transpose=1"},
                                            {"flip_x=1 flip_y=1", "rotate_deg=180"}}) {
        const auto first = made("geometry " + there);
        const auto turned = passed(*first, events, 99);
        for (const auto& event : turned) {
            ASSERT_LT(event.x, first->geometry().width);
            ASSERT_LT(event.y, first->geometry().height);
        }
        const auto second = made("geometry " + back, first->geometry());
        EXPECT_EQ(second->geometry(), small);
        EXPECT_EQ(passed(*second, turned, 99), events) << there << " then " << back;
    }
}

TEST(Turn, refuses_odd_angles_and_an_image_with_more_rows_than_a_packet_can_name) {
    EXPECT_THAT(make_filter(*parse_filter("geometry rotate_deg=45"), small).error().message,
                HasSubstr("rotate_deg is 45, must be 0, 90, 180 or 270"));
    EXPECT_THAT(make_filter(*parse_filter("geometry transpose=1"), {32769, 2}).error().message,
                HasSubstr("at most 32768"));
    EXPECT_TRUE(make_filter(*parse_filter("geometry transpose=1"), {32768, 2}));
}

TEST(FilterSetting, is_read_from_text_and_written_back) {
    const auto setting = parse_filter("  undistort a=1.5  b=-2 file=/a b/lens.textproto \n");
    ASSERT_TRUE(setting) << setting.error().message;
    EXPECT_EQ(setting->filter, "undistort");
    EXPECT_EQ(setting->file, "/a b/lens.textproto");
    EXPECT_THAT(setting->parameters,
                ElementsAre(FilterSetting::Value{"a", 1.5}, FilterSetting::Value{"b", -2}));
    EXPECT_EQ(*parse_filter(to_text(*setting)), *setting);
    for (const char* bad : {"", " ", "refractory period_us", "refractory =1",
                            "refractory a=", "refractory a=1x", "pixel_mask file= "}) {
        EXPECT_FALSE(parse_filter(bad)) << bad;
    }
}

TEST(FilterSetting, that_does_not_fit_is_refused_by_name_and_bound) {
    const auto message_of = [](const std::string& text) {
        return make_filter(*parse_filter(text), small).error().message;
    };
    EXPECT_THAT(message_of("refractory period_us=0"),
                HasSubstr("period_us is 0, must be a whole number from 1 to 1000000000 us"));
    EXPECT_THAT(message_of("refractory period_us=1.5"), HasSubstr("whole number"));
    EXPECT_THAT(message_of("refractory period_us=nan"), HasSubstr("period_us is nan"));
    EXPECT_THAT(message_of("refractory period_us=5 period_us=6"), HasSubstr("given twice"));
    EXPECT_THAT(message_of("refractory period=1"), HasSubstr("parameter period is unknown"));
    EXPECT_THAT(message_of("no_such"), HasSubstr("no filter is named \"no_such\""));
    EXPECT_THAT(message_of("pixel_mask"), HasSubstr("file is missing"));
    EXPECT_THAT(message_of("polarity file=a"), HasSubstr("takes none"));
}

}  // namespace
}  // namespace pursuit::sensor
