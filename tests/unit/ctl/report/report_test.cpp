// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/report/report.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <random>

namespace pursuit::ctl {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The first thing that is wrong with the elements of a page, or "": every element is closed in
/// order, every attribute quoted, no bare & or < anywhere.
std::string fault_of(const std::string& page) {
    std::vector<std::string> open;
    for (std::size_t i = 0; i < page.size(); ++i) {
        if (page[i] == '&') {
            const auto end = page.find(';', i);
            const auto name = page.substr(i, end - i + 1);
            static const std::vector<std::string> known = {"&amp;", "&lt;", "&gt;", "&quot;",
                                                           "&#39;"};
            if (std::find(known.begin(), known.end(), name) == known.end()) {
                return "bare & at " + page.substr(i, 30);
            }
        }
        if (page[i] != '<') continue;
        std::size_t end = i + 1;
        bool quoted = false;
        for (; end < page.size() && (quoted || page[end] != '>'); ++end) {
            if (page[end] == '"') quoted = !quoted;
            if (page[end] == '<') return "< inside an element at " + page.substr(i, 60);
        }
        if (end == page.size()) return "an element that does not end: " + page.substr(i, 60);
        const std::string tag = page.substr(i + 1, end - i - 1);
        const auto name = tag.substr(0, tag.find_first_of(" \n"));
        if (tag[0] == '!') {
        } else if (tag[0] == '/') {
            if (open.empty() || open.back() != tag.substr(1)) return "unexpected </" + tag;
            open.pop_back();
        } else if (tag.back() != '/') {
            open.push_back(name);
        }
        i = end;
        if (tag == "style" || tag == "script") i = page.find("</" + tag, i) - 1;
    }
    return open.empty() ? "" : "never closed: " + open.back();
}

std::size_t count(const std::string& page, const std::string& what) {
    std::size_t n = 0;
    for (auto at = page.find(what); at != std::string::npos; at = page.find(what, at + 1)) ++n;
    return n;
}

ReportObject object(const std::string& name, int poses) {
    ReportObject object;
    object.name = name;
    object.id = 7;
    object.points_px = {{-10, -5}, {10, -5}, {10, 5}, {-10, 5}};
    object.edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    for (int i = 0; i < poses; ++i) {
        ReportPose pose;
        pose.t_us = i * 1000;
        pose.x_px = 20 + 0.1 * i;
        pose.y_px = 30;
        object.truth.push_back(pose);
        pose.y_px += 0.2;
        object.poses.push_back(pose);
        object.error_px.push_back({pose.t_us, 0.2});
    }
    object.mean_error_px = 0.2;
    object.lost = false;
    object.lies = 0;
    return object;
}

Report full_report() {
    Report report;
    report.title = "Overtake";
    report.subtitle = "built-in scene, 1 s";
    report.geometry = {120, 80};
    report.objects = {object("van", 600), object("car", 600)};
    for (int i = 0; i < 5; ++i) {
        ReportSlice slice{i * 200'000, i * 200'000 + 10'000, {}};
        for (std::uint16_t k = 0; k < 60; ++k) {
            slice.events.push_back({slice.begin_us, k, 40, static_cast<std::uint8_t>(k % 2)});
        }
        report.slices.push_back(slice);
    }
    ReportCurve curve{"events", "events/s", {}};
    for (int i = 0; i < 100; ++i) curve.samples.push_back({i * 10'000, 1e5 + 1e3 * i});
    report.curves = {curve};
    report.latencies = {{"packet to pose", 110.5, 160, 420, 1800, 12345}};
    report.counts = {{"packets", 5000, false}, {"packets missed", 0, true}};
    report.facts = {{"version", "0.1.0"}};
    return report;
}

TEST(Report, a_page_is_well_formed_and_needs_nothing_from_elsewhere) {
    const auto page = render_report(full_report());
    EXPECT_EQ(fault_of(page), "");
    EXPECT_THAT(page, Not(HasSubstr("http:")));
    EXPECT_THAT(page, Not(HasSubstr("https:")));
    EXPECT_THAT(page, Not(HasSubstr("<link")));
    EXPECT_THAT(page, Not(HasSubstr("url(")));
    EXPECT_THAT(page, Not(HasSubstr("@import")));
    EXPECT_EQ(count(page, "href=\""),
              count(page, "href=\"#") + count(page, "href=\"data:image/png"));
}

TEST(Report, shows_every_slice_object_and_table) {
    const auto page = render_report(full_report());
    EXPECT_EQ(count(page, "<figure class=\"frame\""), 5U);
    EXPECT_EQ(count(page, "<use href=\"#m0\" class=\"found o0\""), 5U);
    EXPECT_EQ(count(page, "<use href=\"#m1\" class=\"truth\""), 5U);
    EXPECT_EQ(count(page, "<svg class=\"plot\""), 7U);  // Two objects of three plots, one rate.
    EXPECT_THAT(page, HasSubstr("Both objects were tracked to the end, nothing was lost"));
    EXPECT_THAT(page, HasSubstr("packet to pose"));
    EXPECT_THAT(page, HasSubstr("12345"));
    EXPECT_THAT(page, Not(HasSubstr("To keep this page small")));
}

TEST(Report, the_verdict_names_what_went_wrong) {
    auto report = full_report();
    EXPECT_TRUE(verdict(report).good);
    report.counts[1].count = 3;
    EXPECT_FALSE(verdict(report).good);
    EXPECT_THAT(verdict(report).text, HasSubstr("data was lost: 3 packets missed"));
    report.objects[1].lost = true;
    EXPECT_EQ(verdict(report).text,
              "1 of 2 objects tracked to the end — car: lost; lost data: 3 packets missed");
    report.objects[0].lies = 4;
    EXPECT_THAT(verdict(report).text, HasSubstr("van: followed, with 4 confident wrong poses"));
    EXPECT_EQ(verdict(Report{}).text, "No object was tracked");
    auto by_state = object("x", 3);
    by_state.lost.reset();
    EXPECT_TRUE(verdict(by_state).good);
    by_state.poses.back().state = ReportPose::State::lost;
    EXPECT_FALSE(verdict(by_state).good);
    EXPECT_FALSE(verdict(object("x", 0)).good);
}

TEST(Report, every_string_is_escaped) {
    const std::string evil = "</script><b onclick=\"x\">&'\x01\xff";
    auto report = full_report();
    report.title = report.subtitle = evil;
    report.objects[0].name = evil;
    report.curves[0].name = report.curves[0].unit = evil;
    report.latencies[0].name = report.counts[0].name = evil;
    report.counts[1] = {evil, 1, true};
    report.facts = {{evil, evil}};
    const auto page = render_report(report);
    EXPECT_EQ(fault_of(page), "");
    EXPECT_EQ(count(page, "</script>"), 1U);
    EXPECT_THAT(page, Not(HasSubstr("<b on")));
    EXPECT_THAT(page, Not(HasSubstr("\x01")));
    EXPECT_THAT(page, Not(HasSubstr("\xff")));
}

TEST(Report, nothing_at_all_gives_a_page) {
    const auto page = render_report(Report{});
    EXPECT_EQ(fault_of(page), "");
    EXPECT_THAT(page, HasSubstr("No object was tracked"));
}

TEST(Report, values_that_are_no_numbers_are_left_out) {
    auto report = full_report();
    for (auto& pose : report.objects[0].poses) pose.x_px = pose.a00 = nan;
    report.objects[0].error_px.assign(50, {0, nan});
    report.objects[0].mean_error_px = nan;
    report.objects[0].points_px[2].first = std::numeric_limits<double>::infinity();
    report.objects[1].poses.clear();
    report.objects[1].truth.clear();
    report.objects[1].error_px.clear();
    report.objects[1].edges.push_back({900, 2});
    report.curves[0].samples[3].value = nan;
    report.latencies[0].p50_us = nan;
    const auto page = render_report(report);
    EXPECT_EQ(fault_of(page), "");
    EXPECT_EQ(count(page, "nan"), 0U);
    EXPECT_EQ(count(page, "inf"), 0U);
    EXPECT_THAT(page, HasSubstr("no values"));
    EXPECT_EQ(count(page, "class=\"found o0\""), 0U);
}

TEST(Report, one_pose_and_one_event_at_the_border_are_drawn) {
    Report report;
    report.geometry = {1, 1};
    report.objects = {object("x", 1)};
    report.slices = {{0, 0, {{0, 0, 0, 1}, {0, 1, 0, 1}, {0, 65535, 65535, 0}}}};
    const auto page = render_report(report);
    EXPECT_EQ(fault_of(page), "");
    EXPECT_EQ(count(page, "class=\"found o0\""), 1U);
}

TEST(Report, an_outline_is_dashed_while_occluded_and_absent_while_lost) {
    auto report = full_report();
    for (auto& pose : report.objects[0].poses) pose.state = ReportPose::State::occluded;
    for (auto& pose : report.objects[1].poses) pose.state = ReportPose::State::lost;
    const auto page = render_report(report);
    EXPECT_EQ(count(page, "class=\"found occluded o0\""), 5U);
    EXPECT_EQ(count(page, "class=\"found o1\""), 0U);
    EXPECT_THAT(page, HasSubstr("class=\"shade-lost\""));
}

TEST(Report, stays_small_whatever_it_is_given_and_says_what_it_left_out) {
    Report report = full_report();
    report.geometry = {1280, 720};
    std::mt19937 random(1);
    report.slices.clear();
    for (int i = 0; i < 40; ++i) {
        ReportSlice slice{i * 1000, i * 1000 + 1000, {}};
        for (int k = 0; k < 100'000; ++k) {
            slice.events.push_back({0, static_cast<std::uint16_t>(random() % 1280),
                                    static_cast<std::uint16_t>(random() % 720),
                                    static_cast<std::uint8_t>(random() % 2)});
        }
        report.slices.push_back(std::move(slice));
    }
    report.objects.assign(300, object("many", 20'000));
    report.facts.assign(1000, {"name", std::string(10'000, 'x')});
    const auto page = render_report(report);
    EXPECT_EQ(fault_of(page), "");
    EXPECT_LE(page.size(), ReportLimits().page_bytes);
    EXPECT_THAT(page, HasSubstr("To keep this page small:"));
    EXPECT_THAT(page, HasSubstr(" of 40 pictures are shown."));
    EXPECT_THAT(page, HasSubstr("12 of 300 objects with curves and outlines are shown."));
    EXPECT_THAT(page, HasSubstr("256 of 300 rows"));
    EXPECT_THAT(page, HasSubstr("256 of 1000 facts"));
    EXPECT_THAT(page, HasSubstr("Curves have at most 700 points"));
}

}  // namespace
}  // namespace pursuit::ctl
