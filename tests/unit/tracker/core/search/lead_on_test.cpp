// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/search/lead_on.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/search/fired_map.hpp"
#include "services/tracker/core/search/shape_search.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::small_sensor;

constexpr std::int64_t asked_us = 150'000;

// Goes right by 15 px and turns by half a radian meanwhile.
Coast going() { return {asked_us, pose_of(150, 120, 0.4), {100, 0, 3.3, 0, 0}}; }

std::vector<Event> events_of_it() {
    const auto truth = [](double t_us) {
        return going().at(static_cast<std::int64_t>(t_us), 1).pose;
    };
    return test::outline_events(test::arrow(), truth, 0, asked_us, 20, 0, small_sensor, 3);
}

TEST(LeadOn, brings_what_an_object_made_to_where_it_is_now) {
    const auto truth = going();
    const Eigen::Vector2d tip_px(20, 0);
    std::vector<Event> events;
    for (std::int64_t t_us = 0; t_us <= asked_us; t_us += 10'000) {
        const Pose pose = truth.at(t_us, 1).pose;
        const Eigen::Vector2d p = pose.t_px + pose.a * tip_px;
        events.push_back({t_us, static_cast<std::uint16_t>(std::lround(p.x())),
                          static_cast<std::uint16_t>(std::lround(p.y())), 1});
    }
    lead_on(events, asked_us, truth, small_sensor);
    const Eigen::Vector2d now_px = truth.pose.t_px + truth.pose.a * tip_px;
    for (const Event& event : events) {
        EXPECT_NEAR(event.x, now_px.x(), 1.3);
        EXPECT_NEAR(event.y, now_px.y(), 1.3);
    }
}

TEST(LeadOn, shows_an_object_where_its_events_as_they_are_hardly_do) {
    const Contour contour(test::arrow());
    ShapeSearch search(contour);
    auto events = events_of_it();
    FiredMap map;
    map.build(small_sensor, events);
    search.begin(map, {});
    const Pose in_their_midst = going().at(asked_us / 2, 1).pose;
    const double as_they_are = search.score_of(in_their_midst) + search.explained(in_their_midst);
    lead_on(events, asked_us, going(), small_sensor);
    map.build(small_sensor, events);
    const double led_on = search.score_of(going().pose) + search.explained(going().pose);
    EXPECT_GT(led_on, as_they_are + 0.5);
}

}  // namespace
}  // namespace pursuit::tracker
