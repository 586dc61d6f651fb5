// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/evaluation/evaluate.hpp"

#include <algorithm>

#include "services/common/csv.hpp"
#include "services/ctl/evaluation/pairs.hpp"
#include "services/ctl/evaluation/paper_error.hpp"
#include "services/ctl/evaluation/point_error.hpp"
#include "services/ctl/evaluation/slopes.hpp"
#include "services/ctl/evaluation/speed_errors.hpp"
#include "services/ctl/evaluation/statistics.hpp"

namespace pursuit::ctl {
namespace {

constexpr double lost_px = 5;
constexpr double lie_px = 10;
constexpr double acquired_px = 3;
constexpr std::size_t acquired_times = 20;
constexpr double final_us = 20e3;

void score_errors(const Pairs& pairs, const PointError& point_error, int symmetry, Score& score) {
    Numbers error;
    Numbers symmetric;
    Numbers dx;
    Numbers dy;
    Numbers turn;
    std::size_t lies = 0;
    std::size_t symmetric_lies = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto& pose = pairs.pose[i];
        const auto& reference = pairs.reference[i];
        error.push_back(point_error(pose, reference));
        symmetric.push_back(point_error(pose, reference, symmetry));
        lies += pairs.confident[i] && error.back() > lie_px ? 1 : 0;
        symmetric_lies += pairs.confident[i] && symmetric.back() > lie_px ? 1 : 0;
        dx.push_back(pose[0] - reference[0]);
        dy.push_back(pose[1] - reference[1]);
        turn.push_back(wrapped(angle_rad(pose) - angle_rad(reference)));
    }
    const auto is_final = [&](std::size_t i) {
        return pairs.t_us[i] >= pairs.t_us.back() - final_us;
    };
    const auto is_tracking = [&](std::size_t i) { return bool{pairs.tracking[i]}; };
    score.error = mean(error);
    score.error_p95 = quantile(error, 0.95);
    score.error_max = *std::max_element(error.begin(), error.end());
    score.error_final = mean(where(error, is_final));
    score.error_visible = mean(where(error, [&](std::size_t i) { return bool{pairs.visible[i]}; }));
    score.error_tracking = mean(where(error, is_tracking));
    score.lost = *score.error_final > lost_px;
    score.lies = share(lies, pairs.size());
    score.lies_s = static_cast<double>(lies) * 1e-6 * median_step_us(pairs.t_us);
    score.tracking_fraction = share(where(error, is_tracking).size(), pairs.size());
    score.coverage = share(pairs.size(), pairs.wanted);
    score.x_bias = mean(dx);
    score.x_sigma = deviation(dx);
    score.y_bias = mean(dy);
    score.y_sigma = deviation(dy);
    score.theta_bias = mean(turn);
    score.theta_sigma = deviation(turn);
    std::size_t in_a_row = 0;
    for (std::size_t i = 0; i < pairs.size() && !score.acquired_s; ++i) {
        in_a_row = pairs.tracking[i] && error[i] < acquired_px ? in_a_row + 1 : 0;
        if (in_a_row == acquired_times) {
            score.acquired_s = pairs.t_us[i + 1 - acquired_times] * 1e-6;
        }
    }
    if (symmetry > 1) {
        score.symmetric_error = mean(symmetric);
        score.symmetric_error_p95 = quantile(symmetric, 0.95);
        score.symmetric_error_max = *std::max_element(symmetric.begin(), symmetric.end());
        score.symmetric_lost = *mean(where(symmetric, is_final)) > lost_px;
        score.symmetric_lies = share(symmetric_lies, pairs.size());
    }
}

Score score_object(const ObjectRows* poses, const ObjectRows& truth, const ModelPoints& model,
                   int symmetry, const std::vector<Event>* events,
                   const EvaluationSettings& settings) {
    Score score;
    for (std::size_t i = 0; i < truth.t_us.size() && !score.whole_in_view_s; ++i) {
        if (truth.visible[i] >= 0.95) score.whole_in_view_s = truth.t_us[i] * 1e-6;
    }
    if (poses == nullptr) return score;
    score.pose_rows = poses->t_us.size();
    const auto track = started_rows(*poses);
    if (track.t_us.empty()) return score;
    score.first_pose_s = track.t_us.front() * 1e-6;
    for (std::size_t i = 0; i < track.t_us.size() && !score.first_lost_s; ++i) {
        if (track.state[i] == "LOST") score.first_lost_s = track.t_us[i] * 1e-6;
    }
    const auto pairs = pair_up(track, truth, settings);
    if (pairs.size() == 0) return score;
    score_errors(pairs, PointError(model), symmetry, score);
    score_speeds(pairs, settings.speed_window_s, score);
    if (events != nullptr) {
        const auto d1 = paper_error(*events, track.t_us, track.pose, model, pairs.t_us.front(),
                                    pairs.t_us.back(), settings.fresh_ms * 1e3);
        score.d1_events = d1 ? static_cast<double>(d1->events) : 0;
        if (d1) {
            score.d1 = d1->mean_px;
            score.d1_sigma = d1->sigma_px;
        }
    }
    return score;
}

/// Truth can be compared with where its numbers are whole and its times rise.
Result<void> check_truth(const ObjectRows& truth) {
    const std::string name = "truth of " + truth.model + " (object " + truth.object_id + ")";
    if (truth.t_us.size() < 2) return fail(name + ": has fewer than two rows");
    for (std::size_t i = 0; i < truth.t_us.size(); ++i) {
        const auto at =
            name + ": at " + std::to_string(static_cast<std::int64_t>(truth.t_us[i])) + " us: ";
        if (!is_finite(truth.pose[i])) return fail(at + "a number of the pose is missing");
        if (i > 0 && truth.t_us[i] == truth.t_us[i - 1]) return fail(at + "there are two rows");
    }
    return {};
}

/// The range from settings.from_s on, for people.
std::string range_of(const EvaluationSettings& settings) {
    std::string text = "from ";
    append_number(text, settings.from_s);
    if (settings.to_s <= 0) return text + " s on";
    append_number(text += " to ", settings.to_s);
    return text + " s";
}

const ObjectRows* match(const std::vector<ObjectRows>& poses, const ObjectRows& truth, bool by_id) {
    const ObjectRows* first = nullptr;
    for (const auto& rows : poses) {
        if (rows.model == truth.model && rows.object_id == truth.object_id) return &rows;
        if (first == nullptr && rows.model == truth.model) first = &rows;
    }
    if (first != nullptr || !by_id) return first;
    for (const auto& rows : poses) {
        if (rows.object_id == truth.object_id) return &rows;
    }
    return nullptr;
}

}  // namespace

Result<std::vector<Score>> evaluate(const std::vector<ObjectRows>& poses,
                                    const std::vector<ObjectRows>& truth,
                                    const std::map<std::string, ModelPoints>& models,
                                    const std::vector<Event>* events,
                                    const EvaluationSettings& settings) {
    const bool no_name_known = std::none_of(
        poses.begin(), poses.end(), [&](const auto& rows) { return models.contains(rows.model); });
    std::vector<Score> scores;
    bool any_scored = false;
    for (const auto& rows : truth) {
        const auto model = models.find(rows.model);
        if (model == models.end()) continue;
        if (auto ok = check_truth(rows); !ok) return tl::unexpected(ok.error());
        any_scored =
            any_scored || std::any_of(rows.t_us.begin(), rows.t_us.end(),
                                      [&](double t_us) { return is_scored(t_us, settings); });
        const auto turns = settings.symmetry.find(rows.model);
        auto score =
            score_object(match(poses, rows, no_name_known), rows, model->second,
                         turns == settings.symmetry.end() ? 1 : turns->second, events, settings);
        const auto of_that_name = std::count_if(truth.begin(), truth.end(), [&](const auto& other) {
            return other.model == rows.model;
        });
        score.object = of_that_name == 1 ? rows.model : rows.model + "#" + rows.object_id;
        scores.push_back(std::move(score));
    }
    if (!scores.empty() && !any_scored) {
        return fail("no row of the truth lies in the scored range, " + range_of(settings));
    }
    return scores;
}

}  // namespace pursuit::ctl
