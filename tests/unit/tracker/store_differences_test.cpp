// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/store_differences.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

/// A configured arrow, and the object that a former run made of it.
class StoreDifferences : public ::testing::Test {
 protected:
    StoreDifferences() {
        configured_.shape = test::arrow();
        configured_.start.pose = pose_of(50, 60, 0.5);
        auto tracker = Tracker::create({}).value();
        settings_ = tracker.settings();
        EXPECT_TRUE(tracker.register_object(configured_));
        stored_ = tracker.object("arrow").value();
    }
    std::string told() { return differences(configured_, stored_, settings_.new_objects); }

    Registration configured_;
    RegisteredObject stored_;
    Settings settings_;
};

TEST_F(StoreDifferences, are_none_of_what_was_made_of_the_same_configuration) {
    EXPECT_EQ(told(), "");
    EXPECT_EQ(differences(settings_, {}), "");
}

TEST_F(StoreDifferences, are_named_one_by_one) {
    configured_.shape.points_px[0].x() += 1;
    configured_.start.pose.t_px.x() += 1;
    settings_.new_objects.gate_px += 1;
    const auto gate = stored_.parameters.gate_px;
    EXPECT_EQ(told(), "shape, start, gate_px " + std::to_string(static_cast<int>(gate)) +
                          " instead of " + std::to_string(static_cast<int>(gate + 1)));
    configured_.start.search = true;
    EXPECT_EQ(told().substr(0, 13), "shape, start,");
}

TEST_F(StoreDifferences, of_settings_are_those_that_requests_had_set_otherwise) {
    const double gate = settings_.new_objects.gate_px;
    EXPECT_EQ(differences(settings_, {{}, {}, {{"gate_px", gate}}}), "");
    EXPECT_EQ(
        differences(settings_, {StrategyKind::temporal, {}, {{"gate_px", 0.5}}}).substr(0, 29),
        "strategy, gate_px 0.5 instead");
}

}  // namespace
}  // namespace pursuit::tracker
