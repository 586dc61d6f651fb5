// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/lookout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow_per_ms;
using test::noise_per_ms;
using test::outline_events;
using test::rms_px;
using test::small_sensor;

class LookingOut : public testing::Test {
 protected:
    LookingOut() {
        contour_.fit(Eigen::Matrix2d::Identity(), 8);
        lookout_.restart();
    }

    /// Looks five times and more about `own` at these events; the last look.
    Lookout::Sight look_at(const std::vector<Event>& events, const Pose& own) {
        Coast coast{0, own, {}};
        lookout_.look(coast, contour_.gyration_px(), contour_.radius_px(), true);
        Lookout::Sight sight;
        for (const Event& event : events) {
            while (event.t_us >= coast.t_us + Lookout::every_us) {
                coast.t_us += Lookout::every_us;
                sight = lookout_.look(coast, contour_.gyration_px(), contour_.radius_px(), true);
                most_z_ = std::max(most_z_, sight.own_z);
                times_elsewhere_ += sight.instead.has_value();
            }
            lookout_.see(event);
        }
        return sight;
    }

    const Shape shape_ = test::arrow();
    Contour contour_{shape_};
    Lookout lookout_{contour_};
    double most_z_ = -1e9;
    int times_elsewhere_ = 0;
};

TEST_F(LookingOut, sees_an_object_that_goes_among_noise_where_it_is_and_how_it_goes) {
    const auto truth = [](double t_us) {
        return pose_of(150 + 100e-6 * t_us, 120 - 60e-6 * t_us, 0.3 + 1e-6 * t_us);
    };
    const auto events =
        outline_events(shape_, truth, 0, 24'500, arrow_per_ms, noise_per_ms(100), small_sensor, 3);
    // Its place is told 3 px off, and turned.
    Pose own = truth(24'000);
    own.t_px += Eigen::Vector2d(2, -2.2);
    own.a = rotation(-0.15) * own.a;
    const Lookout::Sight sight = look_at(events, own);
    EXPECT_LT(sight.own_z, 6);
    ASSERT_TRUE(sight.instead);
    EXPECT_GT(sight.instead_z, 8);
    EXPECT_LT(rms_px(shape_, sight.instead->pose, truth(24'000)), 1);
    EXPECT_NEAR(sight.instead->velocity.vx_px_s, 100, 50);
    EXPECT_NEAR(sight.instead->velocity.vy_px_s, -60, 50);
}

/// What a look at this shape finds, going, of its turns the one nearest to the angle.
double nearest_rad(const Shape& shape, double found_rad, double near_rad) {
    const auto truth = [](double t_us) { return pose_of(150 + 300e-6 * t_us, 120, 0.3); };
    Lookout lookout{Contour{shape}};
    Coast own{0, truth(0), {300, 0, 0, 0, 0}};
    lookout.look(own, 20, 30, true);
    for (const Event& event :
         outline_events(shape, truth, 0, 24'500, arrow_per_ms, noise_per_ms(30), small_sensor, 3)) {
        while (event.t_us >= own.t_us + Lookout::every_us) {
            own = own.at(own.t_us + Lookout::every_us, 1);
            lookout.look(own, 20, 30, true);
        }
        lookout.see(event);
    }
    own.pose.a = rotation(found_rad);
    return theta_rad(lookout.nearest_turn(own, near_rad).pose.a);
}

TEST(NearestTurn, of_a_shape_that_maps_onto_itself_is_that_nearest_to_where_it_was) {
    std::vector<Eigen::Vector2d> corners_px;
    for (int i = 0; i < 10; ++i) {
        const double at_rad = i * std::numbers::pi / 5;
        const double r_px = i % 2 == 0 ? 30 : 13;
        corners_px.emplace_back(r_px * std::cos(at_rad), r_px * std::sin(at_rad));
    }
    const Shape star = test::polygon("star", corners_px);
    constexpr double of_a_turn_rad = 2 * std::numbers::pi / 5;
    EXPECT_NEAR(nearest_rad(star, 0.3 + of_a_turn_rad, 0.2), 0.3, 0.06);
    EXPECT_NEAR(nearest_rad(star, 0.3 - 2 * of_a_turn_rad, 0.5), 0.3, 0.06);
    EXPECT_NEAR(nearest_rad(star, 0.3, 0.2), 0.3, 1e-9);
}

TEST(NearestTurn, of_any_other_shape_is_the_one_that_was_found) {
    EXPECT_NEAR(nearest_rad(test::arrow(), 0.3, 1.5), 0.3, 1e-9);
}

TEST_F(LookingOut, sees_that_an_object_is_where_it_is_thought_to_be) {
    const auto truth = [](double t_us) { return pose_of(150 + 60e-6 * t_us, 120, 0.3); };
    const auto events =
        outline_events(shape_, truth, 0, 24'500, arrow_per_ms, noise_per_ms(30), small_sensor, 4);
    const Lookout::Sight sight = look_at(events, truth(24'000));
    EXPECT_GT(sight.own_z, 8);
    EXPECT_FALSE(sight.instead);
}

TEST_F(LookingOut, sees_nothing_where_there_is_noise_alone) {
    for (const double hz : {20.0, 100.0, 300.0}) {
        most_z_ = -1e9;
        look_at(outline_events(
                    shape_, [](double) { return pose_of(150, 120, 0.3); }, 0, 120'500, 0,
                    noise_per_ms(hz), small_sensor, 5),
                pose_of(150, 120, 0.3));
        EXPECT_LT(most_z_, 4) << hz;
        lookout_.restart();
    }
    EXPECT_LE(times_elsewhere_, 1);
}

TEST_F(LookingOut, sees_that_there_is_noise_alone_beside_an_object_or_that_there_is_not) {
    const auto truth = [](double t_us) { return pose_of(150 + 100e-6 * t_us, 120, 0.3); };
    auto events =
        outline_events(shape_, truth, 0, 24'500, arrow_per_ms, noise_per_ms(8), small_sensor, 4);
    EXPECT_TRUE(look_at(events, truth(24'000)).is_even);
    // Also where the object is rather elsewhere.
    Pose beside = truth(24'000);
    beside.t_px += Eigen::Vector2d(3, -4);
    lookout_.restart();
    const Lookout::Sight sight = look_at(events, beside);
    EXPECT_TRUE(sight.is_even);
    EXPECT_TRUE(sight.instead);

    // Windows that pass as a camera shakes; one of them is as long as the arrow.
    const Shape window = test::polygon("window", {{-30, -6}, {30, -6}, {30, 6}, {-30, 6}});
    const auto passing = [](double t_us) { return pose_of(148, 141 - 60e-6 * t_us, 0.25); };
    const auto of_window =
        outline_events(window, passing, 0, 24'500, arrow_per_ms, 0, small_sensor, 5);
    events.insert(events.end(), of_window.begin(), of_window.end());
    std::stable_sort(events.begin(), events.end(),
                     [](const Event& l, const Event& r) { return l.t_us < r.t_us; });
    for (const Pose& own : {truth(24'000), beside}) {
        lookout_.restart();
        const Lookout::Sight among_others = look_at(events, own);
        EXPECT_FALSE(among_others.is_even);
        EXPECT_FALSE(among_others.instead);
    }
}

TEST(Lookout, takes_no_part_of_a_long_contour_for_something_else) {
    // A comb: 22 teeth, 1300 px of contour.
    std::vector<Eigen::Vector2d> corners_px{{-55, 20}};
    for (int i = 0; i < 22; ++i) {
        const double x_px = -55 + 5 * i;
        corners_px.insert(corners_px.end(),
                          {{x_px, -20 + 30 * (i % 2)}, {x_px + 5, -20 + 30 * (i % 2)}});
    }
    corners_px.emplace_back(55, 20);
    const Shape comb = test::polygon("comb", corners_px);
    const auto truth = [](double t_us) { return pose_of(150 + 100e-6 * t_us, 120, 0.3); };
    Contour contour{comb};
    Lookout lookout{contour};
    Coast own{0, truth(0), {100, 0, 0, 0, 0}};
    lookout.look(own, contour.gyration_px(), contour.radius_px(), true);
    Lookout::Sight sight;
    for (const Event& event : outline_events(comb, truth, 0, 44'500, 6 * arrow_per_ms,
                                             noise_per_ms(8), small_sensor, 3)) {
        while (event.t_us >= own.t_us + Lookout::every_us) {
            own = own.at(own.t_us + Lookout::every_us, 1);
            sight = lookout.look(own, contour.gyration_px(), contour.radius_px(), true);
        }
        lookout.see(event);
    }
    EXPECT_GT(sight.own_z, 8);
    EXPECT_TRUE(sight.is_even);
}

TEST_F(LookingOut, sees_nothing_of_what_is_another_objects) {
    const auto truth = [](double t_us) { return pose_of(150 + 60e-6 * t_us, 120, 0.3); };
    const auto events = outline_events(shape_, truth, 0, 24'500, arrow_per_ms, 0, small_sensor, 4);
    Coast own{0, truth(24'000), {}};
    lookout_.look(own, contour_.gyration_px(), contour_.radius_px(), true);
    for (const Event& event : events) {
        lookout_.see(event);
        lookout_.disown(event);
    }
    const auto& seen = lookout_.fresh().events;
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](const auto& of_pixel) {
        return of_pixel[0] == 0 && of_pixel[1] == 0;
    }));
    // What was never seen is not missed.
    lookout_.disown({25'000, 150, 120, 1});
    lookout_.disown({25'000, 0, 0, 0});
    lookout_.see({25'000, 150, 120, 1});
    // Nor does it take an earlier one of its pixel away.
    lookout_.disown({25'100, 150, 120, 1});
    EXPECT_EQ(std::count_if(seen.begin(), seen.end(),
                            [](const auto& of_pixel) { return of_pixel[1] == 1; }),
              1);
}

TEST_F(LookingOut, takes_the_border_of_the_image_for_nothing) {
    // What lies beyond it makes no events.
    look_at(outline_events(
                shape_, [](double) { return pose_of(20, 15, 0.3); }, 0, 120'500, 0,
                noise_per_ms(100), small_sensor, 8),
            pose_of(20, 15, 0.3));
    EXPECT_LT(most_z_, 4);
    EXPECT_EQ(times_elsewhere_, 0);
}

TEST_F(LookingOut, takes_no_edge_of_something_else_for_the_object) {
    // As long as the arrow's longest, it goes along it and then on.
    Shape edge{"edge", {{-19, 0}, {19, 0}}, {{0, 1}}};
    const Pose own = pose_of(150, 120, 0);
    const auto passing = [](double t_us) { return pose_of(140, 100 + 300e-6 * t_us, 0); };
    auto events = outline_events(edge, passing, 0, 100'000, 60, noise_per_ms(30), small_sensor, 6);
    look_at(events, own);
    EXPECT_EQ(times_elsewhere_, 0);
}

}  // namespace
}  // namespace pursuit::tracker
