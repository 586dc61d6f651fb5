// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/geometry/shape.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace pursuit::tracker {
namespace {

using testing::HasSubstr;

Shape triangle() { return {"triangle", {{0, 0}, {10, 0}, {0, 10}}, {{0, 1}, {1, 2}, {2, 0}}}; }

TEST(Shape, takes_a_triangle) { EXPECT_TRUE(check(triangle())); }

TEST(Shape, refuses_names_that_are_empty_too_long_or_have_other_characters) {
    for (const std::string& name : {std::string(), std::string(64, 'a'), std::string("a b"),
                                    std::string("ä"), std::string("a/b")}) {
        Shape shape = triangle();
        shape.name = name;
        ASSERT_FALSE(check(shape)) << name;
        EXPECT_THAT(check(shape).error().message, HasSubstr("name"));
    }
    Shape shape = triangle();
    shape.name = std::string(63, 'Z');
    EXPECT_TRUE(check(shape));
}

TEST(Shape, refuses_too_few_and_too_many_points) {
    Shape shape = triangle();
    shape.edges.clear();
    shape.points_px.resize(2);
    EXPECT_FALSE(check(shape));
    shape.points_px.resize(4096, {1, 2});
    EXPECT_TRUE(check(shape));
    shape.points_px.resize(4097, {1, 2});
    EXPECT_FALSE(check(shape));
}

TEST(Shape, names_the_point_that_is_not_finite_or_too_far) {
    for (const float bad : {std::nanf(""), INFINITY, 4096.5F, -5000.0F}) {
        Shape shape = triangle();
        shape.points_px[2].y() = bad;
        ASSERT_FALSE(check(shape));
        EXPECT_THAT(check(shape).error().message, HasSubstr("points[2]"));
    }
}

TEST(Shape, refuses_a_shape_without_extent) {
    Shape shape{"dot", {{5, 5}, {5, 5}, {5.5, 5}}, {}};
    EXPECT_FALSE(check(shape));
}

TEST(Shape, names_the_edge_to_a_point_that_is_not_there) {
    Shape shape = triangle();
    shape.edges[1] = {1, 3};
    ASSERT_FALSE(check(shape));
    EXPECT_THAT(check(shape).error().message, HasSubstr("edges[1]"));
    shape.edges[1] = {1, 1};
    EXPECT_FALSE(check(shape));
}

TEST(Shape, is_moved_to_its_centre_of_gravity) {
    const Shape moved = centred(triangle());
    EXPECT_FLOAT_EQ(moved.points_px[0].x(), -10.0F / 3);
    EXPECT_FLOAT_EQ(moved.points_px[1].x(), 20.0F / 3);
    EXPECT_EQ(moved.edges, triangle().edges);
}

TEST(Shape, is_the_same_bit_for_bit_when_centred_again) {
    std::mt19937 random(1);
    for (int round = 0; round < 2000; ++round) {
        const float extent_px = std::ldexp(1.0F, static_cast<int>(random() % 12));
        std::uniform_real_distribution<float> coordinate_px(-extent_px, 2 * extent_px);
        Shape shape{"random", {}, {}};
        const std::size_t count = 3 + random() % 60;
        for (std::size_t i = 0; i < count; ++i) {
            shape.points_px.emplace_back(coordinate_px(random), coordinate_px(random));
        }
        const Shape once = centred(shape);
        ASSERT_EQ(centred(once), once) << "round " << round;
        ASSERT_LT(centre_of_gravity_px(once).norm(), 1e-3);
    }
}

}  // namespace
}  // namespace pursuit::tracker
