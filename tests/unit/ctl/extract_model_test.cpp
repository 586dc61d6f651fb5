// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/extraction/extract_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "services/ctl/extraction/contour_links.hpp"
#include "services/ctl/extraction/dominant_motion.hpp"
#include "services/ctl/extraction/thinning.hpp"

namespace pursuit::ctl {
namespace {

using testing::HasSubstr;

/// Gives events that it was given.
class EventList final : public sensor::EventReader {
 public:
    explicit EventList(std::vector<Event> events) : events_(std::move(events)) {}
    Geometry geometry() const override { return {160, 120}; }

 protected:
    Decoded decode(std::span<Event> out, std::span<Event> /*exposures*/) override {
        const auto count = std::min(out.size(), events_.size() - next_);
        std::copy_n(events_.begin() + static_cast<std::ptrdiff_t>(next_), count, out.begin());
        next_ += count;
        Decoded done;
        done.count = count;
        return done;
    }

 private:
    std::vector<Event> events_;
    std::size_t next_ = 0;
};

constexpr double vx_px_s = 240;
constexpr double vy_px_s = -120;

/// The outline of a square of 40 px, whose centre is at (70, 60) at 10 ms, for 20 ms; and noise.
std::vector<Event> moving_square(std::size_t noise_events, unsigned seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
    };
    std::vector<Event> events;
    const auto add = [&](std::int64_t t_us, double x, double y, unsigned polarity) {
        events.push_back({t_us, static_cast<std::uint16_t>(std::lround(x)),
                          static_cast<std::uint16_t>(std::lround(y)),
                          static_cast<std::uint8_t>(polarity)});
    };
    for (int i = 0; i < 3000; ++i) {
        const auto t_us = static_cast<std::int64_t>(uniform(0, 20'000));
        const double t_s = (static_cast<double>(t_us) - 10'000) * 1e-6;
        const double along = uniform(-20, 20);
        const unsigned side = random() % 4;
        const double across = side < 2 ? -20 : 20;
        add(t_us, 70 + vx_px_s * t_s + (side % 2 == 0 ? along : across),
            60 + vy_px_s * t_s + (side % 2 == 0 ? across : along), side / 2);
    }
    for (std::size_t i = 0; i < noise_events; ++i) {
        add(static_cast<std::int64_t>(uniform(0, 20'000)), uniform(0, 159), uniform(0, 119),
            random() % 2);
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const Event& l, const Event& r) { return l.t_us < r.t_us; });
    return events;
}

Extraction task_of(std::size_t points) {
    Extraction task;
    task.name = "square";
    task.points = points;
    return task;
}

double distance_to_outline_px(const Eigen::Vector2d& at) {
    const Eigen::Vector2d from_centre = (at - Eigen::Vector2d(70, 60)).cwiseAbs();
    return std::abs(from_centre.maxCoeff() - 20);
}

TEST(ExtractModel, finds_the_outline_at_the_middle_of_the_window_with_its_corners) {
    EventList recording(moving_square(400, 1));
    const auto extracted = extract_model(recording, task_of(60));
    ASSERT_TRUE(extracted) << extracted.error().message;
    EXPECT_NEAR(extracted->velocity_px_s.x(), vx_px_s, 25);
    EXPECT_NEAR(extracted->velocity_px_s.y(), vy_px_s, 25);
    const auto& shape = extracted->model.shape;
    EXPECT_EQ(shape.points_px.size(), 60U);
    const auto origin_px = *extracted->model.origin_px;
    std::vector<Eigen::Vector2d> points_px;
    for (const auto& point : shape.points_px) points_px.push_back(origin_px + point.cast<double>());
    for (const auto& point : points_px)
        EXPECT_LT(distance_to_outline_px(point), 1.5) << point.transpose();
    for (const double x : {50.0, 90.0}) {
        for (const double y : {40.0, 80.0}) {
            double nearest_px = 1e9;
            for (const auto& point : points_px) {
                nearest_px = std::min(nearest_px, (point - Eigen::Vector2d(x, y)).norm());
            }
            EXPECT_LT(nearest_px, 2.0) << x << " " << y;
        }
    }
}

TEST(ExtractModel, gives_the_same_model_for_events_of_equal_time_in_any_order) {
    auto events = moving_square(400, 2);
    for (auto& event : events) event.t_us = event.t_us / 100 * 100;
    EventList as_they_are(events);
    std::stable_sort(events.begin(), events.end(), [](const Event& l, const Event& r) {
        return std::tuple(l.t_us, r.x, r.y) < std::tuple(r.t_us, l.x, l.y);
    });
    EventList reordered(events);
    const auto a = extract_model(as_they_are, task_of(100));
    const auto b = extract_model(reordered, task_of(100));
    ASSERT_TRUE(a);
    ASSERT_TRUE(b);
    EXPECT_EQ(a->model.shape, b->model.shape);
    EXPECT_EQ(a->model.origin_px, b->model.origin_px);
}

TEST(ExtractModel, tells_a_bright_edge_from_a_dark_one_close_beside_it) {
    std::vector<Event> events;
    for (int i = 0; i < 3000; ++i) {
        const auto y = static_cast<std::uint16_t>(30 + i * 7 % 61);
        events.push_back({i * 6, static_cast<std::uint16_t>(i % 2 == 0 ? 50 : 52), y,
                          static_cast<std::uint8_t>(i % 2)});
    }
    EventList recording(events);
    const auto extracted = extract_model(recording, task_of(40));
    ASSERT_TRUE(extracted) << extracted.error().message;
    const auto& shape = extracted->model.shape;
    EXPECT_GE(shape.edges.size(), 30U);
    for (const auto& edge : shape.edges) {
        const auto link = shape.points_px[edge.to] - shape.points_px[edge.from];
        EXPECT_LT(std::abs(link.x()), 0.5F);
    }
}

TEST(ExtractModel, takes_only_what_lies_in_window_and_rectangle) {
    EventList recording(moving_square(0, 3));
    auto task = task_of(50);
    task.x_px = 80;
    task.width_px = 80;
    task.start_us = 5'000;
    task.window_us = 10'000;
    const auto extracted = extract_model(recording, task);
    ASSERT_TRUE(extracted);
    std::size_t expected = 0;
    for (const auto& event : moving_square(0, 3)) {
        expected += event.x >= 80 && event.t_us >= 5'000 && event.t_us < 15'000 ? 1 : 0;
    }
    EXPECT_EQ(extracted->events, expected);
    for (const auto& point : extracted->model.shape.points_px) {
        EXPECT_GT(point.x() + extracted->model.origin_px->x(), 77);
    }
}

TEST(ExtractModel, says_that_too_little_moved_and_what_is_wrong_with_a_task) {
    const auto error_of = [](std::vector<Event> events, const Extraction& task) {
        EventList recording(std::move(events));
        const auto extracted = extract_model(recording, task);
        return extracted ? "" : extracted.error().message;
    };
    EXPECT_THAT(error_of({}, task_of(50)), HasSubstr("only 0 events moved"));
    EXPECT_THAT(error_of({{1, 5, 5, 1}, {2, 50, 50, 1}}, task_of(50)), HasSubstr("only 2 events"));
    EXPECT_THAT(error_of({}, task_of(2)), HasSubstr("points: must be 3 to 4096"));
    auto task = task_of(50);
    task.x_px = 160;
    EXPECT_THAT(error_of({}, task), HasSubstr("within the image of 160x120"));
    task = task_of(50);
    task.window_us = 0;
    EXPECT_THAT(error_of({}, task), HasSubstr("window"));
    task = task_of(50);
    task.name = "a b";
    EXPECT_THAT(error_of({}, task), HasSubstr("name"));
}

TEST(DominantMotion, of_what_stands_still_or_only_flickers_is_zero) {
    std::mt19937 random(4);
    std::vector<MovedEvent> events;
    for (int i = 0; i < 2000; ++i) {
        events.push_back({{static_cast<float>(random() % 50), static_cast<float>(random() % 50)},
                          static_cast<float>(random() % 1000) / 1000 - 0.5F,
                          static_cast<std::uint8_t>(random() % 2)});
    }
    EXPECT_EQ(dominant_motion_px(events), Eigen::Vector2f::Zero());
    EXPECT_EQ(dominant_motion_px({}), Eigen::Vector2f::Zero());
}

TEST(DominantMotion, is_found_to_a_tenth_of_a_pixel) {
    for (const Eigen::Vector2f& motion_px : {Eigen::Vector2f(4.4F, -1.3F), {-2.7F, 3.6F}}) {
        std::mt19937 random(5);
        const auto uniform = [&] { return static_cast<float>(random()) / 4294967296.0F; };
        std::vector<MovedEvent> events;
        for (int i = 0; i < 6000; ++i) {  // a ring: it has edges of every direction
            const float phase = uniform() - 0.5F;
            const float angle = 6.2831853F * uniform();
            const Eigen::Vector2f at = 25 * Eigen::Vector2f(std::cos(angle), std::sin(angle)) +
                                       Eigen::Vector2f(60, 60) + phase * motion_px;
            events.push_back({at.array().round(), phase, static_cast<std::uint8_t>(random() % 2)});
        }
        EXPECT_LT((dominant_motion_px(events) - motion_px).norm(), 0.15F) << motion_px.transpose();
    }
}

TEST(Thin, keeps_every_point_where_they_are_few_and_far_apart) {
    const std::vector<EdgePoint> points = {{{0, 0}, 3, 0}, {{5, 0}, 2, 0}, {{0, 5}, 1, 0}};
    EXPECT_EQ(thin(points, 10).size(), 3U);
    EXPECT_EQ(thin(points, 2).size(), 2U);
    EXPECT_TRUE(thin({}, 2).empty());
    EXPECT_TRUE(thin(points, 0).empty());
}

TEST(Thin, gives_the_number_with_even_spacing) {
    std::mt19937 random(5);
    std::vector<EdgePoint> points;
    for (int i = 0; i < 3000; ++i) {
        points.push_back({{static_cast<float>(random() % 10'000) / 100,
                           static_cast<float>(random() % 4'000) / 100},
                          static_cast<float>(3000 - i),
                          0});
    }
    for (const std::size_t most : {3U, 40U, 300U}) {
        const auto chosen = thin(points, most);
        EXPECT_EQ(chosen.size(), most);
        float nearest_px = 1e9F;
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                nearest_px =
                    std::min(nearest_px, (chosen[i].position_px - chosen[j].position_px).norm());
            }
        }
        float widest_gap_px = 0;
        for (const auto& point : points) {
            float gap_px = 1e9F;
            for (const auto& other : chosen) {
                gap_px = std::min(gap_px, (point.position_px - other.position_px).norm());
            }
            widest_gap_px = std::max(widest_gap_px, gap_px);
        }
        // A covering by discs of twice the radius that packs: even to that factor.
        EXPECT_LE(widest_gap_px, 2 * nearest_px);
    }
}

TEST(ContourLinks, join_neighbours_along_an_edge_and_nothing_across_a_gap) {
    std::vector<Eigen::Vector2f> events;
    std::vector<Eigen::Vector2f> points;
    for (const float y : {0.0F, 6.0F}) {  // two parallel edges, the second with a hole
        for (int i = 0; i <= 200; ++i) {
            const float x = 0.2F * static_cast<float>(i);
            if (y > 0 && x > 17 && x < 23) continue;
            events.emplace_back(x, y + (i % 2 == 0 ? 0.2F : -0.2F));
        }
        for (int i = 0; i < 14; ++i) points.emplace_back(1 + 3.0F * static_cast<float>(i), y);
    }
    const auto links = contour_links(points, events);
    for (const auto& link : links) {
        EXPECT_EQ(link.to, link.from + 1);
        EXPECT_EQ(points[link.from].y(), points[link.to].y());
        const bool in_hole =
            points[link.from].y() > 0 && points[link.to].x() > 18 && points[link.from].x() < 22;
        EXPECT_FALSE(in_hole) << points[link.from].transpose();
    }
    EXPECT_GE(links.size(), 20U);
}

TEST(ContourLinks, join_nothing_in_a_tangle_or_without_events) {
    std::mt19937 random(6);
    std::vector<Eigen::Vector2f> events;
    for (int i = 0; i < 20'000; ++i) {
        events.emplace_back(static_cast<float>(random() % 4000) / 100,
                            static_cast<float>(random() % 4000) / 100);
    }
    std::vector<Eigen::Vector2f> points;
    for (int i = 0; i < 100; ++i) {
        points.emplace_back(5 + 3.0F * static_cast<float>(i % 10),
                            5 + 3.0F * static_cast<float>(i / 10));
    }
    EXPECT_TRUE(contour_links(points, events).empty());
    EXPECT_TRUE(contour_links(points, {}).empty());
}

}  // namespace
}  // namespace pursuit::ctl
