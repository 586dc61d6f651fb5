// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/pose_csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/temporary_folder.hpp"

namespace pursuit::ctl {
namespace {

using testing::HasSubstr;

PoseRow row_with_awkward_numbers() {
    PoseRow row;
    row.t_us = 1'633'953'690'975'950;
    row.last_event_t_us = row.t_us - 1;
    row.object_id = 7;
    row.model = "van";
    row.state = tracker::TrackState::occluded;
    row.pose.t_px = {1.0 / 3, -0.0};
    row.pose.a << 0.1, -1e-300, 1e22, 5e-324;
    row.theta_rad = -3.141592653589793;
    row.vx_px_s = 123456789.123456789;
    row.confidence = 0.1F;
    row.residual_px = 1.0F / 3;
    return row;
}

TEST(PoseCsv, reads_back_the_same_bits) {
    const test::TemporaryFolder folder;
    auto writer = PoseCsvWriter::create(folder.path("p.csv"));
    ASSERT_TRUE(writer);
    const std::vector<PoseRow> rows = {row_with_awkward_numbers(), PoseRow{}};
    for (auto row : rows) {
        if (row.model.empty()) row.model = "car";
        ASSERT_TRUE(writer->write(row));
    }
    ASSERT_TRUE(writer->close());
    const auto read = read_pose_csv(folder.path("p.csv"));
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->size(), 2U);
    EXPECT_EQ((*read)[0], rows[0]);
    EXPECT_TRUE(std::signbit((*read)[0].pose.t_px.y()));
    std::string again(pose_csv_header);
    for (const auto& row : *read) append_pose_csv(again, row);
    EXPECT_EQ(again, test::content_of(folder.path("p.csv")));
}

TEST(PoseCsv, has_the_columns_in_their_order) {
    EXPECT_EQ(pose_csv_header,
              "t_us,last_event_t_us,object_id,model,state,x_px,y_px,a00,a01,a10,a11,theta_rad,"
              "scale_x,scale_y,vx_px_s,vy_px_s,omega_rad_s,confidence,residual_px\n");
    std::string text;
    append_pose_csv(text, row_with_awkward_numbers());
    EXPECT_THAT(text, HasSubstr("1633953690975950,1633953690975949,7,van,OCCLUDED,"
                                "0.3333333333333333,-0,0.1,-1e-300,1e+22,5e-324,"));
    EXPECT_THAT(text, HasSubstr(",0.1,0.33333334\n"));
}

TEST(PoseCsv, names_what_is_wrong_in_a_table) {
    const test::TemporaryFolder folder;
    const auto error_of = [&](const std::string& text) {
        return read_pose_csv(folder.file("p.csv", text)).error().message;
    };
    std::string row;
    append_pose_csv(row, row_with_awkward_numbers());
    const std::string header(pose_csv_header);
    EXPECT_THAT(error_of("t_us\n1\n"), HasSubstr("p.csv: has no column last_event_t_us"));
    EXPECT_THAT(error_of(header + "x" + row), HasSubstr("p.csv:2: column t_us"));
    auto bad_state = row;
    bad_state.replace(bad_state.find("OCCLUDED"), 8, "GONE");
    EXPECT_THAT(error_of(header + row + bad_state),
                HasSubstr("p.csv:3: column state: \"GONE\" is not a state"));
}

TEST(PoseCsv, says_that_a_disk_is_full) {
    auto writer = PoseCsvWriter::create("/dev/full");
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->write(row_with_awkward_numbers()));
    EXPECT_FALSE(writer->close());
}

}  // namespace
}  // namespace pursuit::ctl
