// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/vanishing.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/pixels/recent_pixels.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

/// A box of 60 by 40 px in the middle of a small image that is watched, its events and others.
class WatchedBox {
 public:
    WatchedBox()
        : contour_(test::polygon("box", {{-30, -20}, {30, -20}, {30, 20}, {-30, 20}})),
          silhouette_(contour_),
          vanishing_(silhouette_, contour_.radius_px()) {
        pixels_.restart({side_px, side_px});
    }

    void fires(std::int64_t t_us, int x, int y, std::uint8_t polarity = 1) {
        events_.push_back({t_us, static_cast<std::uint16_t>(x + side_px / 2),
                           static_cast<std::uint16_t>(y + side_px / 2), polarity});
    }
    /// `per_ms` events a ms near its contour, this share of them on it.
    void moves(std::int64_t from_us, std::int64_t to_us, int per_ms,
               double on_contour = usual_share) {
        for (std::int64_t t_us = from_us; t_us < to_us; t_us += 1000 / per_ms)
            own_.push_back({t_us, uniform() < on_contour});
    }
    /// Of `hz` a pixel.
    void noise(std::int64_t from_us, std::int64_t to_us, double hz) {
        const double count = hz * side_px * side_px * static_cast<double>(to_us - from_us) * 1e-6;
        for (int i = 0; i < static_cast<int>(count); ++i) {
            fires(from_us +
                      static_cast<std::int64_t>(uniform() * static_cast<double>(to_us - from_us)),
                  any_place(), any_place(), static_cast<std::uint8_t>(random_() & 1U));
        }
    }
    /// Each place for which `covers` fires once, at any time of these.
    template <class Covers>
    void changes(std::int64_t from_us, std::int64_t span_us, Covers covers) {
        for_places([&](int x, int y) {
            if (!covers(x, y)) return;
            fires(from_us + static_cast<std::int64_t>(uniform() * static_cast<double>(span_us)), x,
                  y);
        });
    }
    /// An edge goes over the image in the x direction.
    void edge_passes(std::int64_t at_middle_us, double speed_px_s, std::uint8_t polarity) {
        for_places([&](int x, int y) {
            fires(at_middle_us + static_cast<std::int64_t>(x * 1e6 / speed_px_s + 50 * uniform()),
                  x, y, polarity);
        });
    }
    [[nodiscard]] static bool is_covered(int x, int y) {
        return std::abs(x) <= 30 && std::abs(y) <= 20;
    }

    /// All that was made, in order; how often it was suspected, and where it was, gone.
    Vanishing& watch(std::int64_t until_us) {
        std::stable_sort(events_.begin(), events_.end(),
                         [](const Event& a, const Event& b) { return a.t_us < b.t_us; });
        const Pose middle = pose_of(side_px / 2, side_px / 2, 0);
        auto own = own_.begin();
        for (const Event& event : events_) {
            for (; own != own_.end() && own->t_us <= event.t_us; ++own) own_event(*own);
            const bool was_suspected = vanishing_.is_suspected();
            vanishing_.see(event, middle, pixels_.note(event).since_same_us);
            if (!was_suspected && vanishing_.is_suspected()) ++suspected_;
            was_gone_ |= vanishing_.is_gone(event.t_us);
        }
        for (; own != own_.end(); ++own) own_event(*own);
        was_gone_ |= vanishing_.is_gone(until_us);
        return vanishing_;
    }
    [[nodiscard]] int suspected() const { return suspected_; }
    [[nodiscard]] bool was_gone() const { return was_gone_; }

 private:
    struct Own {
        std::int64_t t_us;
        bool is_sharp;
    };

    static constexpr int side_px = 120;
    static constexpr double usual_share = 0.95;

    void own_event(const Own& own) {
        vanishing_.count_own(own.t_us, own.is_sharp ? 1 : 0, own.is_sharp ? 0 : 1, usual_share);
        was_gone_ |= vanishing_.is_gone(own.t_us);
    }
    double uniform() { return static_cast<double>(random_()) / 4294967296.0; }
    int any_place() { return static_cast<int>(random_() % side_px) - side_px / 2; }
    template <class Visit>
    void for_places(const Visit& visit) {
        for (int y = -side_px / 2; y < side_px / 2; ++y) {
            for (int x = -side_px / 2; x < side_px / 2; ++x) visit(x, y);
        }
    }

    Contour contour_;
    Silhouette silhouette_;
    Vanishing vanishing_;
    RecentPixels pixels_;
    std::mt19937 random_{7};
    std::vector<Event> events_;
    std::vector<Own> own_;
    int suspected_ = 0;
    bool was_gone_ = false;
};

TEST(Vanishing, is_told_by_all_of_the_inside_at_once_and_silence_after_it) {
    for (const int per_ms : {0, 1, 20}) {
        for (const double noise_hz : {0.1, 10.0, 100.0}) {
            WatchedBox box;
            box.noise(0, 150'000, noise_hz);
            box.moves(0, 100'000, std::max(per_ms, 1));
            box.changes(100'000, 2'000, WatchedBox::is_covered);
            const Vanishing& vanishing = box.watch(140'000);
            EXPECT_EQ(box.suspected(), 1) << per_ms << " " << noise_hz;
            EXPECT_TRUE(vanishing.is_gone(140'000)) << per_ms << " " << noise_hz;
            EXPECT_FALSE(vanishing.is_gone(130'000)) << per_ms << " " << noise_hz;
        }
    }
}

TEST(Vanishing, is_none_where_the_contour_goes_on) {
    WatchedBox box;
    box.noise(0, 300'000, 1);
    box.moves(0, 300'000, 20);
    box.changes(100'000, 2'000, WatchedBox::is_covered);
    EXPECT_FALSE(box.watch(300'000).is_suspected());
    EXPECT_EQ(box.suspected(), 1);
    EXPECT_FALSE(box.was_gone());
}

TEST(Vanishing, is_told_where_another_contour_makes_as_many_events_after_it) {
    WatchedBox box;
    box.noise(0, 300'000, 1);
    box.moves(0, 100'000, 20);
    box.changes(100'000, 2'000, WatchedBox::is_covered);
    box.moves(100'000, 300'000, 20, 0.6);
    const Vanishing& vanishing = box.watch(300'000);
    EXPECT_TRUE(box.was_gone());
    EXPECT_TRUE(vanishing.is_gone(140'000));
}

// What another shape covers as well does not change, and beside it it changes what is about.
TEST(Vanishing, is_told_by_a_part_of_the_inside_at_once_and_events_that_do_not_fit_after_it) {
    for (const int about_px : {0, 15}) {
        for (const double on_contour : {0.25, 0.5}) {
            WatchedBox box;
            box.noise(0, 140'000, 1);
            box.moves(0, 100'000, 20);
            box.changes(100'000, 2'000, [&](int x, int y) {
                return WatchedBox::is_covered(x, y) ? x < 0 : std::abs(y) < 20 + about_px;
            });
            box.moves(100'000, 140'000, 20, on_contour);
            EXPECT_TRUE(box.watch(140'000).is_gone(140'000)) << about_px << " " << on_contour;
        }
    }
}

TEST(Vanishing, is_none_where_a_part_of_the_inside_fires_and_what_comes_fits_as_usual) {
    for (const int per_ms : {1, 20}) {
        WatchedBox box;
        box.noise(0, 300'000, 1);
        box.moves(0, 300'000, per_ms);
        box.changes(100'000, 2'000,
                    [](int x, int y) { return WatchedBox::is_covered(x, y) && x < 0; });
        box.watch(300'000);
        EXPECT_FALSE(box.was_gone()) << per_ms;
    }
}

/// At 100 ms, and then nothing but noise until 300 ms.
void go_until_half_of_the_inside_changes(WatchedBox& box) {
    box.noise(0, 300'000, 1);
    box.moves(0, 100'000, 20);
    box.changes(100'000, 2'000, [](int x, int y) { return WatchedBox::is_covered(x, y) && x < 0; });
}

TEST(Vanishing, is_none_where_a_part_of_the_inside_fires_and_nothing_comes_after_it) {
    WatchedBox box;
    go_until_half_of_the_inside_changes(box);
    box.watch(300'000);
    EXPECT_FALSE(box.was_gone());
}

TEST(Vanishing, is_none_where_what_does_not_fit_comes_long_after_a_part_of_the_inside_fired) {
    WatchedBox box;
    go_until_half_of_the_inside_changes(box);
    box.moves(220'000, 300'000, 20, 0.3);
    box.watch(300'000);
    EXPECT_FALSE(box.was_gone());
}

TEST(Vanishing, is_none_where_an_edge_passes_over_it_and_what_comes_then_does_not_fit) {
    for (const double speed_px_s : {4'000.0, 10'000.0}) {
        WatchedBox box;
        box.noise(0, 300'000, 1);
        box.moves(0, 100'000, 20);
        box.edge_passes(100'000, speed_px_s, 1);
        box.moves(100'000, 200'000, 20, 0.3);
        box.watch(300'000);
        EXPECT_FALSE(box.was_gone()) << speed_px_s;
    }
}

// Its events and the light's together do not fit as usual; after it they do.
TEST(Vanishing, is_none_where_the_light_flickers_for_a_while_and_the_contour_goes_on) {
    WatchedBox box;
    box.noise(0, 400'000, 1);
    box.moves(0, 100'000, 20);
    for (std::int64_t t_us = 100'000; t_us < 130'000; t_us += 6'000) {
        box.changes(t_us, 2'000, [](int, int) { return true; });
    }
    box.moves(100'000, 130'000, 20, 0.5);
    box.moves(130'000, 400'000, 20);
    box.watch(400'000);
    EXPECT_FALSE(box.was_gone());
}

TEST(Vanishing, is_not_seen_in_a_flicker_of_the_light) {
    for (const std::int64_t every_us : {10'000, 100'000}) {
        WatchedBox box;
        box.noise(0, 500'000, 1);
        for (std::int64_t t_us = 50'000; t_us < 450'000; t_us += every_us) {
            box.changes(t_us, 2'000, [](int, int) { return true; });
        }
        box.watch(500'000);
        EXPECT_EQ(box.suspected(), 0) << every_us;
    }
}

TEST(Vanishing, is_not_seen_in_an_edge_or_two_that_pass_at_any_speed) {
    for (const double speed_px_s : {100.0, 1'000.0, 4'000.0, 10'000.0, 30'000.0}) {
        for (const double width_px : {0.0, 6.0, 200.0}) {
            WatchedBox box;
            box.noise(0, 2'000'000, 1);
            box.edge_passes(1'000'000, speed_px_s, 1);
            if (width_px > 0) {
                const double after_us = width_px * 1e6 / speed_px_s;
                box.edge_passes(1'000'000 + static_cast<std::int64_t>(after_us), speed_px_s, 0);
            }
            box.watch(5'000'000);
            EXPECT_EQ(box.suspected(), 0) << speed_px_s << " " << width_px;
        }
    }
}

TEST(Vanishing, is_not_seen_in_noise) {
    for (const double noise_hz : {10.0, 100.0, 300.0}) {
        WatchedBox box;
        box.noise(0, 1'000'000, noise_hz);
        box.watch(1'100'000);
        EXPECT_EQ(box.suspected(), 0) << noise_hz;
    }
}

TEST(Vanishing, is_not_seen_where_half_of_the_inside_fires) {
    WatchedBox box;
    box.noise(0, 100'000, 1);
    box.changes(50'000, 2'000, [](int x, int y) { return WatchedBox::is_covered(x, y) && x < 0; });
    box.watch(200'000);
    EXPECT_EQ(box.suspected(), 0);
}

TEST(Vanishing, is_not_told_before_what_is_usual_is_known) {
    WatchedBox box;
    box.noise(0, 100'000, 1);
    box.changes(10'000, 2'000, WatchedBox::is_covered);
    box.watch(200'000);
    EXPECT_EQ(box.suspected(), 0);
}

TEST(Vanishing, cannot_be_told_of_shapes_without_enough_of_an_inside) {
    const auto can_tell = [](const Shape& shape) {
        const Contour contour(shape);
        return Vanishing(Silhouette(contour), contour.radius_px()).can_tell();
    };
    Shape line{"line", {}, {}};
    for (int i = 0; i < 20; ++i) line.points_px.emplace_back(static_cast<float>(i * 2), 0.0F);
    EXPECT_FALSE(can_tell(line));
    EXPECT_FALSE(can_tell(test::polygon("stick", {{-30, -2}, {30, -2}, {30, 2}, {-30, 2}})));
    EXPECT_FALSE(Vanishing().can_tell());
    EXPECT_TRUE(can_tell(test::arrow()));
    EXPECT_TRUE(can_tell(test::ring("large", 300, 600)));
}

}  // namespace
}  // namespace pursuit::tracker
