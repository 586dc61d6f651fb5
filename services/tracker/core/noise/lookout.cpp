// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/lookout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "services/tracker/core/geometry/contour_samples.hpp"
#include "services/tracker/core/noise/climb.hpp"

namespace pursuit::tracker {
namespace {

constexpr double most_samples = 64;
constexpr double slow_px_s = 30;
constexpr double longest_s = 1;

// Of a place before it is moved uphill.
constexpr double worth_a_climb_z = 3.2;

// Of what stands out in another turn: before it is moved uphill, and after it.
constexpr double climbs_to_same = 0.6;
constexpr double same_share = 0.9;
constexpr double most_turns = 8;

// Beyond chance, with the number of places that are as near; and beyond what the own place shows.
constexpr double beyond_chance_z = 4.7;
constexpr double farther_z_per_px = 0.13;
constexpr double beyond_own_z = 2;
constexpr double beyond_own_times = 1.3;
// Without the best quarter of the contour: an edge of something else lies along a part of it.
constexpr std::size_t best_parts = 2;
constexpr double least_rest_z = 2;
constexpr double least_rest_share = 0.25;

// Of what fired beside it, in pixels that are no farther from a place of the contour than this.
// (Noise comes to 1.1 at most, what lies beside a car that a van overtakes to 1.3, and the edges
// that a moving camera sees to 2 to 10.)
constexpr double most_uneven = 1.5;
constexpr double beside_every_px = 4;

// The steps uphill; of the velocity as far as they take it in the time looked at.
constexpr int most_rounds = 3;
constexpr double velocity_steps_per_s = 80;

std::int64_t age_us(std::size_t slice) {
    return static_cast<std::int64_t>(slice) * Lookout::every_us + Lookout::every_us / 2;
}

}  // namespace

Lookout::Lookout(const Contour& contour) : scores_(turns * places * places) {
    for (const ContourSample& sample : samples_along(contour, most_samples)) {
        samples_.push_back(sample.at_px);
        middle_px_ += sample.at_px;
    }
    const double dense = std::max(most_samples, contour.length_px() / beside_every_px);
    for (const ContourSample& sample : samples_along(contour, dense)) {
        left_out_.push_back(sample.at_px);
    }
    if (!samples_.empty()) middle_px_ /= static_cast<double>(samples_.size());
}

// Every place, as it goes so: the slices are laid over each other, and the contour over them.
void Lookout::look_around(const Coast& own, const Velocity& going) {
    std::fill(work_.begin(), work_.end(), 0.F);
    const auto side = static_cast<int>(window_.side());
    for (std::size_t i = 0; i < FiredWindow::slices; ++i) {
        const double age_s = static_cast<double>(age_us(i)) * 1e-6;
        const auto dx = static_cast<int>(std::lround(age_s * going.vx_px_s));
        const auto dy = static_cast<int>(std::lround(age_s * going.vy_px_s));
        for (int row = std::max(dy, 0); row < side + std::min(dy, 0); ++row) {
            const float* from = window_.slice(i).data() + (row - dy) * side;
            float* to = work_.data() + row * side;
            for (int x = std::max(dx, 0); x < side + std::min(dx, 0); ++x) to[x] += from[x - dx];
        }
    }
    std::fill(scores_.begin(), scores_.end(), 0.F);
    for (std::size_t turn = 0; turn < turns; ++turn) {
        const double angle_rad = (static_cast<double>(turn) - reach_turn) * turn_rad_;
        const Eigen::Matrix2d a = rotation(angle_rad) * own.pose.a;
        float* scores = &scores_[turn * places * places];
        for (const Eigen::Vector2d& sample : samples_) {
            const Eigen::Vector2d p = own.pose.t_px + a * sample;
            const auto column = static_cast<int>(std::lround(p.x())) - window_.left() - reach_px;
            const auto row = static_cast<int>(std::lround(p.y())) - window_.top() - reach_px;
            if (column < 0 || row < 0 || column + 2 * reach_px >= side ||
                row + 2 * reach_px >= side) {
                continue;
            }
            const float* counts = work_.data() + row * side + column;
            for (std::size_t y = 0; y < places; ++y) {
                for (std::size_t x = 0; x < places; ++x) {
                    scores[y * places + x] += counts[y * window_.side() + x];
                }
            }
        }
    }
}

// What chance makes of a score: its mean is that of all places, its variance that of counts.
void Lookout::weigh_noise(const Pose& pose) {
    std::fill(work_.begin(), work_.end(), 0.F);
    for (const Eigen::Vector2d& sample : samples_) {
        const Eigen::Vector2d p = pose.t_px + pose.a * sample;
        const auto column = static_cast<unsigned>(std::lround(p.x()) - window_.left() - 1);
        const auto row = static_cast<unsigned>(std::lround(p.y()) - window_.top() - 1);
        if (column >= window_.side() - 2 || row >= window_.side() - 2) continue;
        constexpr std::array<float, 3> spread{0.25F, 0.5F, 0.25F};
        for (unsigned y = 0; y < 3; ++y) {
            for (unsigned x = 0; x < 3; ++x) {
                work_[(row + y) * window_.side() + column + x] += spread[x] * spread[y];
            }
        }
    }
    double squares = 0;
    for (const float weight : work_) squares += static_cast<double>(weight) * weight;
    mean_ =
        std::accumulate(scores_.begin(), scores_.end(), 0.0) / static_cast<double>(scores_.size());
    sigma_ = std::sqrt(std::max(mean_ / static_cast<double>(samples_.size()) * squares, 1e-6));
}

auto Lookout::scores_of(const Coast& coast) const -> std::array<double, parts> {
    std::array<double, parts> scores{};
    for (std::size_t i = 0; i < FiredWindow::slices; ++i) {
        const Pose pose = coast.at(coast.t_us - age_us(i), longest_s).pose;
        const double left = pose.t_px.x() - window_.left();
        const double top = pose.t_px.y() - window_.top();
        for (std::size_t k = 0; k < samples_.size(); ++k) {
            const Eigen::Vector2d& m = samples_[k];
            const double x = left + pose.a(0, 0) * m.x() + pose.a(0, 1) * m.y();
            const double y = top + pose.a(1, 0) * m.x() + pose.a(1, 1) * m.y();
            if (!(x >= 0 && y >= 0 && x < window_.side() - 1 && y < window_.side() - 1)) continue;
            const auto column = static_cast<unsigned>(x);
            const auto row = static_cast<unsigned>(y);
            const auto right = static_cast<float>(x - column);
            const auto down = static_cast<float>(y - row);
            const float* at = window_.slice(i).data() + row * window_.side() + column;
            const float upper = at[0] + right * (at[1] - at[0]);
            const float lower =
                at[window_.side()] + right * (at[window_.side() + 1] - at[window_.side()]);
            scores[k * parts / samples_.size()] += upper + down * (lower - upper);
        }
    }
    return scores;
}

double Lookout::z_of(const Coast& coast) const {
    const auto scores = scores_of(coast);
    return (std::accumulate(scores.begin(), scores.end(), 0.0) - mean_) / sigma_;
}

bool Lookout::is_all_around(const Coast& coast, double z) const {
    auto scores = scores_of(coast);
    std::sort(scores.begin(), scores.end());
    const double rest = std::accumulate(scores.begin(), scores.end() - best_parts, 0.0);
    constexpr double share = 1 - static_cast<double>(best_parts) / parts;
    const double rest_z = (rest - share * mean_) / (sigma_ * std::sqrt(share));
    return rest_z > std::max(least_rest_z, least_rest_share * z);
}

Coast Lookout::uphill(const Coast& coast, double& z) const {
    z = z_of(coast);
    return climb(coast, z, {most_rounds, velocity_steps_per_s, turn_rad_},
                 [this](const Coast& moved) { return z_of(moved); });
}

Coast Lookout::nearest_turn(const Coast& found, double near_rad) const {
    constexpr double turn_rad = 2 * std::numbers::pi;
    const double z = z_of(found);
    const double found_rad = std::remainder(theta_rad(found.pose.a) - near_rad, turn_rad);
    // Of a shape with so many turns another one is nearer only beyond half of one.
    if (std::abs(found_rad) < std::numbers::pi / most_turns) return found;
    // The nearest first, to the left and to the right.
    for (double off_rad = 0; off_rad + turn_rad_ < std::abs(found_rad); off_rad += turn_rad_) {
        for (const double side : {1.0, -1.0}) {
            Coast turned = found;
            turned.pose.a = rotation(side * off_rad - found_rad) * found.pose.a;
            turned.pose.t_px += (found.pose.a - turned.pose.a) * middle_px_;
            double turned_z = z_of(turned);
            if (turned_z < climbs_to_same * z) continue;
            turned = uphill(turned, turned_z);
            if (turned_z > same_share * z) return turned;
        }
    }
    return found;
}

Coast Lookout::best_of_around(const Coast& own, const Velocity& going) const {
    const auto best = std::max_element(scores_.begin(), scores_.end());
    const auto index = static_cast<std::size_t>(best - scores_.begin());
    Coast coast = own;
    coast.velocity = going;
    coast.pose.t_px.x() += static_cast<double>(index % places) - reach_px;
    coast.pose.t_px.y() += static_cast<double>(index / places % places) - reach_px;
    const double turn = static_cast<double>(index / (places * places)) - reach_turn;
    coast.pose.a = rotation(turn * turn_rad_) * own.pose.a;
    return coast;
}

// Beside both places, lest the object's own edges count where it is rather there.
bool Lookout::is_even(const Coast& own, const std::optional<Coast>& instead) {
    const Eigen::Vector2d corner_px(window_.left(), window_.top());
    beside_.begin(window_.side());
    for (std::size_t i = 0; i < FiredWindow::slices; ++i) beside_.add(window_.slice(i));
    const auto leave_out = [&](const Coast& coast) {
        for (std::size_t i = 0; i < FiredWindow::slices; ++i) {
            const Pose pose = coast.at(coast.t_us - age_us(i), longest_s).pose;
            for (const Eigen::Vector2d& place : left_out_) {
                beside_.leave_out(pose.t_px + pose.a * place - corner_px);
            }
        }
    };
    leave_out(own);
    if (instead) leave_out(*instead);
    // Farther away not every event was asked for, nor where it was not yet.
    const double way_px = std::hypot(own.velocity.vx_px_s, own.velocity.vy_px_s) * 1e-6 *
                          static_cast<double>(age_us(FiredWindow::slices));
    const double asked_px = window_.reach_px() - FiredBeside::near_px - way_px;
    return beside_.unevenness(own.pose.t_px - corner_px, std::max(asked_px, 0.0),
                              window_.seen().from(window_.left(), window_.top())) < most_uneven;
}

void Lookout::look_elsewhere(const Coast& own, Sight& sight) {
    const auto consider = [&](const Velocity& going) {
        const Coast start = best_of_around(own, going);
        double z = z_of(start);
        if (z < worth_a_climb_z) return;
        const Coast coast = uphill(start, z);
        const double off_px = (coast.pose.t_px - own.pose.t_px).norm() +
                              (coast.pose.a - own.pose.a).norm() / std::numbers::sqrt2 / turn_rad_;
        const double enough =
            std::max({beyond_chance_z + farther_z_per_px * off_px,
                      beyond_own_times * sight.own_z + beyond_own_z, sight.instead_z});
        if (z <= enough || !is_all_around(coast, z)) return;
        sight.instead = coast;
        sight.instead_z = z;
    };
    consider({});
    if (std::hypot(own.velocity.vx_px_s, own.velocity.vy_px_s) < slow_px_s) return;
    look_around(own, own.velocity);
    consider(own.velocity);
}

auto Lookout::look(const Coast& own, double gyration_px, double extent_px, bool everywhere)
    -> Sight {
    turn_rad_ = 1 / std::max(gyration_px, 1.0);
    window_.close_slice();
    window_.place(own.pose.t_px, static_cast<int>(std::ceil(extent_px)) + reach_px);
    work_.resize(window_.slice(0).size());
    Sight sight;
    if (samples_.empty()) return sight;
    if (everywhere) {
        look_around(own, {});
        weigh_noise(own.pose);
    }
    sight.own_z = z_of(own);
    if (everywhere) look_elsewhere(own, sight);
    sight.is_even = is_even(own, sight.instead);
    if (!sight.is_even) sight.instead.reset();
    return sight;
}

}  // namespace pursuit::tracker
