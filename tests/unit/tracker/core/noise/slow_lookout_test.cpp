// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>

#include "services/tracker/core/noise/lookout.hpp"
#include "services/tracker/core/noise/slow_lookout.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow_per_ms;
using test::noise_per_ms;
using test::outline_events;
using test::rms_px;
using test::small_sensor;

class LookingOutForWhatIsSlow : public testing::Test {
 protected:
    using Truth = std::function<Pose(double t_us)>;

    /// Looks about `own`, which stands still, at what fires in this time; the last look.
    SlowLookout::Sight look(const Truth& truth, std::int64_t to_us, double noise_hz,
                            const Pose& own, double per_ms = arrow_per_ms) {
        return look(shape_, truth, to_us, noise_hz, own, per_ms);
    }
    /// At those of another shape.
    SlowLookout::Sight look(const Shape& shape, const Truth& truth, std::int64_t to_us,
                            double noise_hz, const Pose& own, double per_ms) {
        const double extent_px = contour_.radius_px() * std::numbers::sqrt2;
        const int side = 2 * static_cast<int>(extent_px + 22) + 1;
        FiredCounts fired;
        fired.side = static_cast<unsigned>(side);
        fired.left = static_cast<int>(own.t_px.x()) - side / 2;
        fired.top = static_cast<int>(own.t_px.y()) - side / 2;
        fired.events.resize(std::size_t{fired.side} * fired.side);
        SlowLookout::Sight sight;
        std::int64_t look_us = Lookout::every_us;
        for (const Event& event : outline_events(shape, truth, 0, to_us + 500, per_ms,
                                                 noise_per_ms(noise_hz), small_sensor, 3)) {
            while (event.t_us >= look_us) {
                slow_.add(fired, own.t_px, extent_px);
                fired.clear();
                if (slow_.is_due()) {
                    sight = slow_.look({look_us, own, {}}, contour_.gyration_px());
                    most_z_ = std::max(most_z_, sight.z);
                }
                look_us += Lookout::every_us;
            }
            const Eigen::Vector2d off_px = Eigen::Vector2d(event.x, event.y) - own.t_px;
            if (off_px.norm() < extent_px + 7) {
                fired.see(event.x, event.y, event.polarity ^ (is_bright_ ? 1 : 0));
            }
        }
        return sight;
    }

    const Shape shape_ = test::arrow();
    Contour contour_{shape_};
    SlowLookout slow_{contour_};
    bool is_bright_ = false;
    double most_z_ = 0;
};

TEST_F(LookingOutForWhatIsSlow, sees_what_turns_on_the_spot_among_noise) {
    const Truth truth = [](double t_us) { return pose_of(150, 120, 0.3 + 1e-6 * t_us); };
    const auto sight = look(truth, 160'000, 100, truth(0));
    EXPECT_GT(sight.z, 8);
    EXPECT_LT(rms_px(shape_, sight.best.pose, truth(160'000)), 1);
    EXPECT_NEAR(sight.best.velocity.omega_rad_s, 1, 0.5);
}

TEST_F(LookingOutForWhatIsSlow, sees_what_goes_slowly_and_where_it_was_not_thought_to_be) {
    const Truth truth = [](double t_us) { return pose_of(150 + 30e-6 * t_us, 120, 0.3); };
    Pose own = truth(160'000);
    own.t_px += Eigen::Vector2d(-4, 1);
    const auto sight = look(truth, 160'000, 30, own);
    EXPECT_GT(sight.z, 8);
    EXPECT_LT(rms_px(shape_, sight.best.pose, truth(160'000)), 1);
    EXPECT_NEAR(sight.best.velocity.vx_px_s, 30, 10);
}

TEST_F(LookingOutForWhatIsSlow, sees_where_it_has_stopped) {
    const Truth truth = [](double t_us) {
        return pose_of(150 + 30e-6 * std::min(t_us, 90'000.0), 120, 0.3);
    };
    const auto sight = look(truth, 160'000, 30, truth(0));
    EXPECT_GT(sight.z, 8);
    EXPECT_EQ(sight.best.velocity, Velocity());
    EXPECT_LT(rms_px(shape_, sight.best.pose, truth(160'000)), 1);
}

TEST_F(LookingOutForWhatIsSlow, sees_a_bright_object_as_well_as_a_dark_one) {
    const Truth truth = [](double t_us) { return pose_of(150 + 30e-6 * t_us, 120, 0.3); };
    is_bright_ = true;
    const auto sight = look(truth, 160'000, 30, truth(160'000));
    EXPECT_GT(sight.z, 8);
    EXPECT_NEAR(sight.best.velocity.vx_px_s, 30, 10);
}

TEST_F(LookingOutForWhatIsSlow, sees_nothing_where_there_is_noise_alone) {
    const Truth truth = [](double) { return pose_of(150, 120, 0.3); };
    for (const double hz : {5.0, 30.0, 100.0}) {
        slow_.restart();
        most_z_ = 0;
        look(truth, 1'000'000, hz, truth(0), 0);
        EXPECT_LT(most_z_, 6) << hz;
        EXPECT_GT(most_z_, 2) << hz;
    }
}

TEST_F(LookingOutForWhatIsSlow, tells_that_an_edge_of_something_else_lies_along_a_part_alone) {
    const Shape edge{"edge", {{-19, 0}, {19, 0}}, {{0, 1}}};
    const Truth passing = [](double t_us) { return pose_of(140, 112 + 40e-6 * t_us, 0); };
    const auto other = look(edge, passing, 160'000, 30, pose_of(150, 120, 0), 60);
    EXPECT_GT(other.z, 6);
    EXPECT_FALSE(other.is_all_around);
    slow_.restart();
    const Truth truth = [](double t_us) { return pose_of(150, 120 + 30e-6 * t_us, 0.3); };
    EXPECT_TRUE(look(truth, 160'000, 30, truth(160'000)).is_all_around);
}

TEST_F(LookingOutForWhatIsSlow, takes_the_border_of_the_image_for_nothing) {
    const Truth truth = [](double) { return pose_of(20, 15, 0.3); };
    look(truth, 500'000, 100, truth(0), 0);
    EXPECT_LT(most_z_, 6);
}

}  // namespace
}  // namespace pursuit::tracker
