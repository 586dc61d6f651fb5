// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/model_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_data.hpp"

namespace pursuit::tracker {
namespace {

using testing::HasSubstr;

TEST(ModelFile, a_written_model_is_read_back_bit_for_bit) {
    const pursuit::test::TemporaryFolder folder;
    ModelFile model;
    model.shape.name = "car";
    model.shape.points_px = {{-1.1F, 2.0F / 3}, {0.1F, -1.0F / 3}, {1.0F, -1.0F / 3}};
    model.shape.edges = {{0, 1}, {1, 2}};
    model.shape = centred(model.shape);
    model.origin_px = Eigen::Vector2d(151.1, 1.0 / 3);
    model.comment = "from a drive";
    const auto path = folder.path("car.model.textproto");
    ASSERT_TRUE(write_model_file(path, model));
    const auto read = read_model_file(path);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->shape, model.shape);
    EXPECT_EQ(read->origin_px, model.origin_px);
    EXPECT_EQ(read->comment, model.comment);
}

TEST(ModelFile, reads_points_about_their_centre_of_gravity_whatever_their_origin) {
    const pursuit::test::TemporaryFolder folder;
    const auto model =
        read_model_file(folder.file("model_box.csv", "x_px,y_px\n10,20\n14,20\n14,26\n10,26\n"));
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_EQ(model->shape.name, "box");
    EXPECT_EQ(model->shape.points_px[0], Eigen::Vector2f(-2, -3));
    EXPECT_TRUE(model->shape.edges.empty());
    EXPECT_FALSE(model->origin_px);
}

TEST(ModelFile, takes_edges_beside_a_table_of_points) {
    const pursuit::test::TemporaryFolder folder;
    folder.file("a_edges.csv", "from,to\n0,1\n2,0\n");
    const auto model =
        read_model_file(folder.file("a.csv", "# remark\ny_px, x_px\n0,0\n\n0,4\n3,0\n"));
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_EQ(model->shape.name, "a");
    EXPECT_EQ(model->shape.edges, (std::vector<Edge>{{0, 1}, {2, 0}}));
    EXPECT_EQ(model->shape.points_px[1].y(), -1);
}

TEST(ModelFile, names_file_line_and_cause_of_what_is_wrong) {
    const pursuit::test::TemporaryFolder folder;
    const auto error_of = [&](const std::string& name, const std::string& content) {
        const auto model = read_model_file(folder.file(name, content));
        return model ? "" : model.error().message;
    };
    EXPECT_THAT(error_of("a.csv", "x_px,y_px\n1,2\n1,z\n"),
                HasSubstr("a.csv:3: column y_px: \"z\" is not a number"));
    EXPECT_THAT(error_of("a.csv", "x_px,y_px\n1,2\n1\n"), HasSubstr("a.csv:3: column y_px"));
    EXPECT_THAT(error_of("a.csv", "x,y\n1,2\n"), HasSubstr("a.csv: has no column x_px"));
    EXPECT_THAT(error_of("a.csv", ""), HasSubstr("a.csv: has no line of column names"));
    EXPECT_THAT(error_of("a.csv", "x_px,y_px\n1,2\n"), HasSubstr("a.csv: points: has 1 points"));
    EXPECT_THAT(error_of("a.csv", "x_px,y_px\n1,2\n9,9\nnan,1\n"), HasSubstr("points[2]"));
    EXPECT_THAT(error_of("a b.csv", "x_px,y_px\n1,2\n9,9\n3,1\n"), HasSubstr("name: "));
    std::string many = "x_px,y_px\n";
    for (int i = 0; i < 4097; ++i) many += "1,2\n";
    EXPECT_THAT(error_of("a.csv", many), HasSubstr("a.csv:4098: more rows"));
    EXPECT_THAT(error_of("a.csv", "x_px,y_px\n" + std::string(1 << 17, '1')),
                HasSubstr("a.csv:2: the line is longer than 64 KiB"));
    folder.file("b_edges.csv", "from,to\n0,3\n");
    EXPECT_THAT(error_of("b.csv", "x_px,y_px\n0,0\n9,9\n3,1\n"), HasSubstr("edges[0]"));
    EXPECT_THAT(error_of("a.model.textproto", "name: \"a\"\npoint { x_px: 1 }"),
                HasSubstr("a.model.textproto"));
    EXPECT_THAT(error_of("a.model.textproto", "name: \"a\" origin_x_px: 1"),
                HasSubstr("must come together"));
    EXPECT_THAT(read_model_file(folder.path("none.csv")).error().message,
                HasSubstr("none.csv: cannot open"));
}

TEST(ModelFile, names_the_line_of_what_a_shape_may_not_be) {
    const pursuit::test::TemporaryFolder folder;
    const auto error_of = [&](const std::string& more) {
        const auto path = folder.file(
            "a.model.textproto",
            "point { x_px: 0 y_px: 0 }\npoint { x_px: 9 y_px: 0 }\npoint { x_px: 0 y_px: 9 }\n" +
                more);
        const auto model = read_model_file(path);
        return model ? "" : model.error().message.substr(path.size());
    };
    EXPECT_THAT(error_of("name: 'a'\nedge { from: 0 to: 1 }\nedge {\nfrom: 0 to: 3 }"),
                testing::StartsWith(":6: edges[1]: joins points 0 and 3"));
    EXPECT_THAT(error_of("\nname: 'a b'"), testing::StartsWith(":5: name: has a character"));
    EXPECT_THAT(error_of("name: 'a'\norigin_y_px: 1"),
                testing::StartsWith(":5: origin_x_px and origin_y_px must come"));
    EXPECT_EQ(error_of("name: 'a'\npoint { x_px: 1 }"), ":5: field point[3].y_px is missing");
}

TEST(ModelArgument, is_a_path_with_or_without_a_start) {
    const auto plain = parse_model_argument("a/b.csv");
    ASSERT_TRUE(plain);
    EXPECT_EQ(plain->path, "a/b.csv");
    EXPECT_FALSE(plain->start);

    const auto start = parse_model_argument("x@y.csv@1.5,-2,0.5");
    ASSERT_TRUE(start) << start.error().message;
    EXPECT_EQ(start->path, "x@y.csv");
    EXPECT_EQ(*start->start, pose_of(1.5, -2, 0.5));

    EXPECT_EQ(*parse_model_argument("m@1,2,3,0.5")->start, pose_of(1, 2, 3, 0.5, 0.5));
}

TEST(ModelArgument, says_what_is_wrong_with_a_start) {
    for (const std::string wrong :
         {"m@", "m@1,2", "m@1,2,3,4,5", "m@1,2,x", "m@1,,3", "m@1,2,3,", "m@nan,2,3", "m@1,2,3,0",
          "m@1,2,3,-1", "m@1e9,2,3", "@1,2,3"}) {
        const auto parsed = parse_model_argument(wrong);
        ASSERT_FALSE(parsed) << wrong;
        EXPECT_THAT(parsed.error().message, HasSubstr(wrong));
    }
}

TEST(ModelFile, reads_every_shape_of_the_simulated_streams) {
    PURSUIT_DATA_OR_SKIP(folder, "simulated");
    int models = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const auto name = entry.path().filename().string();
        if (!name.starts_with("model_") || name.ends_with("_edges.csv")) continue;
        const auto model = read_model_file(entry.path().string());
        ASSERT_TRUE(model) << model.error().message;
        EXPECT_EQ(model->shape.edges.empty(), name.starts_with("model_true_")) << name;
        ++models;
    }
    EXPECT_EQ(models, 19);
}

}  // namespace
}  // namespace pursuit::tracker
