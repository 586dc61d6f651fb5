// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/supported_events.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

constexpr Geometry sensor{200, 150};

SupportedEvents::Wish wish_of(const Eigen::Vector2d& around_px, double reach_px,
                              std::int64_t since_us) {
    SupportedEvents::Wish wish;
    wish.around_px = around_px;
    wish.reach_px = reach_px;
    wish.since_us = since_us;
    wish.neighbour_us = 5'000;
    wish.noise_share = 1;  // however many neighbours it has
    wish.most = LastEvents::most;
    return wish;
}

/// A seen stream, and what is gathered of it.
class Stream {
 public:
    Stream() { gathered_.restart(sensor); }

    void see(const Event& event) {
        all_.push_back(event);
        last_.see(event);
    }
    const std::vector<Event>& gather(const SupportedEvents::Wish& wish,
                                     std::span<const SupportedEvents::Cover> covers = {}) {
        gathered_.gather(all_.empty() ? 0 : all_.back().t_us, last_, wish, covers);
        return gathered_.events();
    }
    SupportedEvents& gathered() { return gathered_; }
    const std::vector<Event>& all() const { return all_; }

 private:
    std::vector<Event> all_;
    LastEvents last_;
    SupportedEvents gathered_;
};

void see_noise(Stream& stream, int count, std::int64_t every_us, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> x(0, sensor.width - 1);
    std::uniform_int_distribution<int> y(0, sensor.height - 1);
    const std::int64_t from_us = stream.all().empty() ? 0 : stream.all().back().t_us;
    for (int i = 0; i < count; ++i) {
        stream.see({from_us + i * every_us, static_cast<std::uint16_t>(x(random)),
                    static_cast<std::uint16_t>(y(random)), static_cast<std::uint8_t>(i % 2)});
    }
}

bool is_supported(const std::vector<Event>& all, std::size_t i, std::int64_t since_us) {
    for (std::size_t k = 0; k < i; ++k) {
        const int dx = std::abs(all[i].x - all[k].x);
        const int dy = std::abs(all[i].y - all[k].y);
        // What a pixel has fired itself is no neighbour's.
        if (dx > 1 || dy > 1 || (dx == 0 && dy == 0)) continue;
        if (all[k].t_us >= since_us && all[i].t_us - all[k].t_us < 5'000) return true;
    }
    return false;
}

TEST(SupportedEvents, are_none_of_an_empty_stream) {
    Stream stream;
    EXPECT_TRUE(stream.gather(wish_of({100, 75}, 50, 0)).empty());
    EXPECT_EQ(stream.gathered().mean_age_us(10), 0);
}

TEST(SupportedEvents, are_those_that_brute_force_finds_anywhere_in_the_image) {
    Stream stream;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> x(-20, 220);
    std::uniform_real_distribution<double> y(-20, 170);
    for (unsigned round = 0; round < 12; ++round) {
        see_noise(stream, 300, 20, round);
        const Eigen::Vector2d around_px(x(random), y(random));
        const double reach_px = round == 0 ? 500 : 10.0 * round;
        const std::int64_t since_us = round % 3 == 0 ? 0 : stream.all().back().t_us - 8'000;
        std::vector<Event> expected;
        for (std::size_t i = 0; i < stream.all().size(); ++i) {
            const Event& event = stream.all()[i];
            if (event.t_us < since_us || std::abs(event.x - around_px.x()) >= reach_px ||
                std::abs(event.y - around_px.y()) >= reach_px) {
                continue;
            }
            if (is_supported(stream.all(), i, since_us)) expected.push_back(event);
        }
        EXPECT_EQ(stream.gather(wish_of(around_px, reach_px, since_us)), expected) << round;
    }
}

TEST(SupportedEvents, are_a_small_share_of_noise_and_nearly_all_of_an_edge) {
    for (const int every_us : {4, 16, 64}) {
        Stream stream;
        see_noise(stream, 150'000 / every_us, every_us, 6);
        auto wish = wish_of({100, 75}, 60, 0);
        wish.noise_share = 0.1;
        stream.gather(wish);
        EXPECT_LT(stream.gathered().supported_share(), 0.15) << every_us;
        wish.most = 1;
        stream.gather(wish);
        EXPECT_LT(stream.gathered().supported_share(), 0.15) << every_us;
    }
    Stream stream;
    for (std::int64_t t_us = 0; t_us < 100'000; ++t_us) {
        if (t_us % 16 != 0) continue;
        stream.see({t_us, static_cast<std::uint16_t>(80 + t_us / 2'500),
                    static_cast<std::uint16_t>(50 + t_us / 16 % 50), 1});
    }
    auto wish = wish_of({100, 75}, 60, 0);
    wish.noise_share = 0.1;
    stream.gather(wish);
    EXPECT_GT(stream.gathered().supported_share(), 0.5);
    wish.around_px = {10, 10};
    wish.reach_px = 5;
    stream.gather(wish);
    EXPECT_EQ(stream.gathered().supported_share(), 0);
}

TEST(SupportedEvents, are_the_last_of_them_where_there_are_more_than_asked_for) {
    Stream stream;
    see_noise(stream, 3'000, 4, 2);
    auto wish = wish_of({100, 75}, 60, 0);
    const std::vector<Event> all = stream.gather(wish);
    ASSERT_GT(all.size(), 200U);
    wish.most = 100;
    const std::vector<Event> last(all.end() - 100, all.end());
    EXPECT_EQ(stream.gather(wish), last);
    wish.most = 0;
    EXPECT_TRUE(stream.gather(wish).empty());
}

TEST(SupportedEvents, are_not_of_what_lies_over_it_where_that_was_when_they_came) {
    Stream stream;
    see_noise(stream, 10'000, 4, 3);
    // A square goes to the right by 40 px meanwhile.
    const Shape square = centred(Shape{
        "square", {{-15, -15}, {15, -15}, {15, 15}, {-15, 15}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}});
    const std::vector<SupportedEvents::Cover> covers{
        {Silhouette(Contour(square)), {40'000, {{120, 75}, rotation(0)}, {1'000, 0, 0, 0, 0}}}};
    const auto wish = wish_of({100, 75}, 70, 0);
    const std::vector<Event> without = stream.gather(wish);
    const std::vector<Event> seen = stream.gather(wish, covers);
    int of_cover = 0;
    for (const Event& event : without) {
        const double x_px = 80 + 1e-3 * static_cast<double>(event.t_us);
        const double outside_px = std::max(std::abs(event.x - x_px), std::abs(event.y - 75.0)) - 15;
        const bool is_seen = std::find(seen.begin(), seen.end(), event) != seen.end();
        if (outside_px < 0) {
            EXPECT_FALSE(is_seen) << event.t_us;
            ++of_cover;
        }
        // (A margin of its own, and how fine its silhouette is.)
        if (outside_px > 3) {
            EXPECT_TRUE(is_seen) << event.t_us;
        }
    }
    EXPECT_GT(of_cover, 50);
}

TEST(SupportedEvents, are_of_an_edge_and_little_noise_where_there_is_much_of_it) {
    Stream stream;
    std::mt19937 random(9);
    // An edge of 60 px goes one px a ms, in noise of 10 Hz a pixel.
    for (std::int64_t t_us = 0; t_us < 48'000; t_us += 3) {
        const bool is_edge = t_us % 30 == 0;
        const auto edge_y = static_cast<std::uint16_t>(45 + random() % 60);
        const auto edge_x = static_cast<std::uint16_t>(70 + t_us / 1000);
        stream.see(is_edge ? Event{t_us, edge_x, edge_y, 1}
                           : Event{t_us, static_cast<std::uint16_t>(random() % sensor.width),
                                   static_cast<std::uint16_t>(random() % sensor.height), 0});
    }
    const auto share = [&](const std::vector<Event>& seen, bool is_edge) {
        // (Beside the edge noise has the edge's pixels for neighbours.)
        const auto is_counted = [&](const Event& event) {
            const bool is_in_reach = event.y > 10 && event.y < 140;
            return is_edge ? event.polarity == 1 : event.x > 135 && event.x < 165 && is_in_reach;
        };
        const auto of_all = std::count_if(stream.all().begin(), stream.all().end(), is_counted);
        const auto of_seen = std::count_if(seen.begin(), seen.end(), is_counted);
        return static_cast<double>(of_seen) / static_cast<double>(of_all);
    };
    auto wish = wish_of({100, 75}, 70, 0);
    EXPECT_GT(share(stream.gather(wish), false), 0.2);
    EXPECT_GT(share(stream.gather(wish), true), 0.9);
    wish.noise_share = 0.1;
    EXPECT_LT(share(stream.gather(wish), false), 0.1);
    EXPECT_GT(share(stream.gather(wish), true), 0.5);
}

TEST(SupportedEvents, tell_how_old_they_are_in_the_mean) {
    Stream stream;
    stream.see({100, 50, 50, 1});
    stream.see({200, 51, 50, 1});
    stream.see({300, 52, 50, 1});
    ASSERT_EQ(stream.gather(wish_of({50, 50}, 20, 0)).size(), 2U);
    EXPECT_EQ(stream.gathered().mean_age_us(400), 150);
}

}  // namespace
}  // namespace pursuit::tracker
