// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/evaluation/evaluate.hpp"

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "services/sensor/formats/formats.hpp"
#include "services/tracker/model_file.hpp"
#include "tests/support/test_data.hpp"
#include "tests/unit/ctl/evaluation_case.hpp"
#include "tests/unit/sensor/read_all.hpp"

namespace pursuit::ctl {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;

std::vector<Score> scores_of(const EvaluationCase& files, const EvaluationSettings& settings) {
    std::map<std::string, ModelPoints> models;
    for (const std::string name : {"square", "bar"}) {
        const auto model = tracker::read_model_file(files.path("model_" + name + ".csv"));
        for (const auto& point : model->shape.points_px) {
            models[name].push_back(point.cast<double>());
        }
    }
    auto recording = sensor::open_events(files.path("events.dat"));
    const auto events = sensor::read_all(**recording).events;
    auto scores = evaluate(*read_object_rows(files.path("poses.csv")),
                           *read_object_rows(files.path("truth.csv")), models, &events, settings);
    return scores ? *scores : std::vector<Score>{};
}

EvaluationSettings settings_of_case() {
    EvaluationSettings settings;
    settings.symmetry = {{"square", 4}};
    return settings;
}

google::protobuf::Struct parse(const std::string& json) {
    google::protobuf::Struct parsed;
    EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(json, &parsed).ok()) << json;
    return parsed;
}

TEST(Evaluate, agrees_with_the_independent_reading_of_the_metrics) {
    const auto script = std::filesystem::path(test::data_folder()).parent_path() / "evaluate.py";
    if (!std::filesystem::exists(script)) GTEST_SKIP() << "there is no " << script;
    if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0) {
        GTEST_SKIP() << "there is no python3 with numpy";
    }
    const EvaluationCase files;
    const auto command = "/usr/bin/python3 " + script.string() + " --poses " +
                         files.path("poses.csv") + " --truth " + files.path("truth.csv") +
                         " --model " + files.path("model_square.csv") + " --model " +
                         files.path("model_bar.csv") + " --events " + files.path("events.dat") +
                         " --symmetry square=4 > " + files.path("theirs.json");
    ASSERT_EQ(std::system(command.c_str()), 0);
    const auto theirs = parse(test::content_of(files.path("theirs.json")));
    const auto ours = parse(to_json(scores_of(files, settings_of_case())));
    ASSERT_EQ(theirs.fields_size(), 2);
    int compared = 0;
    for (const auto& [object, score] : theirs.fields()) {
        ASSERT_TRUE(ours.fields().contains(object));
        const auto& own = ours.fields().at(object).struct_value().fields();
        for (const auto& [name, value] : score.struct_value().fields()) {
            ASSERT_TRUE(own.contains(name)) << object << " " << name;
            const auto& own_value = own.at(name);
            EXPECT_EQ(own_value.kind_case(), value.kind_case()) << object << " " << name;
            EXPECT_EQ(own_value.bool_value(), value.bool_value()) << object << " " << name;
            EXPECT_THAT(
                own_value.number_value(),
                DoubleNear(value.number_value(), 1e-7 * (1 + std::abs(value.number_value()))))
                << object << " " << name;
            ++compared;
        }
    }
    EXPECT_GT(compared, 50);
}

TEST(Evaluate, gives_the_values_that_the_independent_reading_gave) {
    const EvaluationCase files;
    const auto scores = scores_of(files, settings_of_case());
    ASSERT_EQ(scores.size(), 2U);
    const auto& square = scores[0];
    const auto& bar = scores[1];
    constexpr double exact = 1e-6;  // models are kept as 32-bit floats
    EXPECT_FALSE(square.lost);
    EXPECT_NEAR(square.error.value(), 1.5642647184912766, exact);
    EXPECT_NEAR(square.error_p95.value(), 12.402373789921441, exact);
    EXPECT_NEAR(square.error_max.value(), 12.406732462085516, exact);
    EXPECT_NEAR(square.error_final.value(), 0.5212788922332473, exact);
    EXPECT_NEAR(square.lies.value(), 0.061762034514078114, exact);
    EXPECT_NEAR(square.lies_s.value(), 0.068, exact);
    EXPECT_NEAR(square.x_bias.value(), 1.4688319709355127, exact);
    EXPECT_NEAR(square.x_sigma.value(), 3.433407597309038, exact);
    EXPECT_NEAR(square.theta_sigma.value(), 0.014530938548325363, exact);
    EXPECT_NEAR(square.coverage.value(), 1.0, exact);
    EXPECT_NEAR(square.tracking_fraction.value(), 0.9791099000908265, exact);
    EXPECT_NEAR(square.first_pose_s.value(), 0.06, exact);
    EXPECT_NEAR(square.first_lost_s.value(), 0.15, exact);
    EXPECT_NEAR(square.acquired_s.value(), 0.20099999999999998, exact);
    EXPECT_NEAR(square.speed_error_pct.value(), 19.72744946924594, exact);
    EXPECT_NEAR(square.velocity_error_pct.value(), 20.39313724344705, exact);
    EXPECT_NEAR(square.omega_error_pct.value(), 3.21371187672049, exact);
    EXPECT_NEAR(square.d1.value(), 2.8664079289197972, exact);
    EXPECT_NEAR(square.d1_sigma.value(), 1.2756277382005188, exact);
    EXPECT_NEAR(square.d1_events.value(), 18529, exact);
    EXPECT_NEAR(square.symmetric_error.value(), 1.5642647184912766, exact);
    EXPECT_TRUE(bar.lost);
    EXPECT_NEAR(bar.error.value(), 2.5193963411998266, exact);
    EXPECT_NEAR(bar.error_p95.value(), 10.362070256469018, exact);
    EXPECT_NEAR(bar.error_max.value(), 12.010412149464313, exact);
    EXPECT_NEAR(bar.error_final.value(), 11.708968753155546, exact);
    EXPECT_NEAR(bar.lies.value(), 0.0, exact);
    EXPECT_NEAR(bar.lies_s.value(), 0.0, exact);
    EXPECT_NEAR(bar.x_bias.value(), 2.186790190735694, exact);
    EXPECT_NEAR(bar.x_sigma.value(), 3.56536940041697, exact);
    EXPECT_NEAR(bar.theta_sigma.value(), 0.0, exact);
    EXPECT_NEAR(bar.coverage.value(), 1.0, exact);
    EXPECT_NEAR(bar.tracking_fraction.value(), 0.0, exact);
    EXPECT_NEAR(bar.first_pose_s.value(), 0.02, exact);
    EXPECT_FALSE(bar.first_lost_s);
    EXPECT_FALSE(bar.acquired_s);
    EXPECT_NEAR(bar.speed_error_pct.value(), 33.370423451144646, exact);
    EXPECT_NEAR(bar.velocity_error_pct.value(), 33.3740357453838, exact);
    EXPECT_FALSE(bar.d1);
    EXPECT_FALSE(bar.d1_sigma);
    EXPECT_NEAR(bar.d1_events.value(), 0, exact);
}

TEST(Evaluate, an_object_without_any_pose_is_lost_and_has_no_error) {
    const EvaluationCase files;
    const auto truth = *read_object_rows(files.path("truth.csv"));
    const std::map<std::string, ModelPoints> models = {{"bar", {{1, 0}, {-1, 0}}}};
    const auto scores = evaluate({}, truth, models, nullptr, {});
    ASSERT_TRUE(scores);
    ASSERT_EQ(scores->size(), 1U);
    EXPECT_TRUE(scores->front().lost);
    EXPECT_FALSE(scores->front().error);
    EXPECT_THAT(to_json(*scores), HasSubstr("\"E\": null"));
}

TEST(Evaluate, the_truth_itself_has_no_error) {
    const EvaluationCase files;
    const auto truth = *read_object_rows(files.path("truth.csv"));
    const std::map<std::string, ModelPoints> models = {{"square", {{1, 0}, {-1, 0}}}};
    const auto scores = *evaluate(truth, truth, models, nullptr, {});
    EXPECT_EQ(scores[0].error, 0.0);
    EXPECT_EQ(scores[0].lies, 0.0);
    EXPECT_FALSE(scores[0].lost);
    EXPECT_NEAR(*scores[0].speed_error_pct, 0, 1e-12);
}

TEST(Evaluate, refuses_truth_that_nothing_can_be_compared_with) {
    const std::map<std::string, ModelPoints> models = {{"a", {{1, 0}, {-1, 0}}}};
    const test::TemporaryFolder folder;
    const auto error_of = [&](const std::string& rows) {
        const auto path = folder.file("t.csv", "t_us,model,x_px,y_px,a00,a01,a10,a11\n" + rows);
        const auto scores = evaluate({}, *read_object_rows(path), models, nullptr, {});
        return scores ? "" : scores.error().message;
    };
    EXPECT_THAT(error_of("1,a,1,1,1,0,0,1\n"), HasSubstr("fewer than two rows"));
    EXPECT_THAT(error_of("1,a,1,1,1,0,0,1\n1,a,1,1,1,0,0,1\n"), HasSubstr("two rows"));
    EXPECT_THAT(error_of("1,a,1,1,1,0,0,1\n2,a,1,,1,0,0,1\n"), HasSubstr("is missing"));
}

TEST(Evaluate, refuses_a_range_in_which_no_truth_lies) {
    const EvaluationCase files;
    const auto truth = *read_object_rows(files.path("truth.csv"));
    const std::map<std::string, ModelPoints> models = {{"bar", {{1, 0}, {-1, 0}}}};
    EvaluationSettings settings;
    settings.from_s = 100.5;
    EXPECT_THAT(evaluate(truth, truth, models, nullptr, settings).error().message,
                HasSubstr("no row of the truth lies in the scored range, from 100.5 s on"));
    settings.to_s = 101;
    EXPECT_THAT(evaluate(truth, truth, models, nullptr, settings).error().message,
                HasSubstr("from 100.5 to 101 s"));
}

TEST(ReadObjectRows, sorts_by_time_and_makes_the_matrix_of_angle_and_scales) {
    const test::TemporaryFolder folder;
    const auto rows = read_object_rows(folder.file(
        "p.csv",
        "t_us,object_id,state,x_px,y_px,theta_rad,scale_x\n5,1,2,1,2,0,3\n4,1,lost,0,0,0,1\n"));
    ASSERT_TRUE(rows);
    ASSERT_EQ(rows->size(), 1U);
    EXPECT_EQ((*rows)[0].t_us, (std::vector<double>{4, 5}));
    EXPECT_EQ((*rows)[0].state, (std::vector<std::string>{"LOST", "OCCLUDED"}));
    EXPECT_EQ((*rows)[0].pose[1], (PoseNumbers{1, 2, 3, 0, 0, 1}));
}

std::string error_of_rows(const std::string& text) {
    const test::TemporaryFolder folder;
    const auto rows = read_object_rows(folder.file("p.csv", text));
    return rows ? "" : rows.error().message;
}

TEST(ReadObjectRows, names_the_line_of_what_is_no_number_of_a_cut_row_and_of_an_unknown_state) {
    const std::string header = "t_us,x_px,y_px,theta_rad,state\n1,2,2,0,LOST\n";
    EXPECT_EQ(error_of_rows(header), "");
    EXPECT_THAT(error_of_rows(header + "2,z,2,0,LOST\n"), HasSubstr("p.csv:3: column x_px"));
    EXPECT_THAT(error_of_rows(header + "2,2,2"),
                HasSubstr("p.csv:3: the row ends before column theta_rad"));
    EXPECT_THAT(error_of_rows(header + "2,2,2,0,TRACKNG\n"),
                HasSubstr("p.csv:3: column state: \"TRACKNG\" is not a state"));
}

TEST(ReadObjectRows, names_a_needed_column_that_is_not_there) {
    EXPECT_THAT(error_of_rows("x_px\n1\n"), HasSubstr("p.csv: has no column t_us"));
    EXPECT_THAT(error_of_rows("t_us,x_pz,y_px,theta_rad\n"), HasSubstr("has no column x_px"));
    EXPECT_THAT(error_of_rows("t_us,x_px,theta_rad\n"), HasSubstr("has no column y_px"));
    EXPECT_THAT(error_of_rows("t_us,x_px,y_px\n"), HasSubstr("a00"));
    EXPECT_THAT(error_of_rows("t_us,x_px,y_px,a00,a01,a1O,a11\n"), HasSubstr("no column a10"));
    EXPECT_EQ(error_of_rows("t_us,x_px,y_px,a00,a01,a10,a11\n"), "");
}

}  // namespace
}  // namespace pursuit::ctl
