// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/clutter.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace pursuit::tracker {
namespace {

constexpr std::int64_t fold_us = 5'000;
constexpr double far_memory_s = 0.5;
constexpr double rise_s = 0.1;  // of what is usual on the contour
constexpr double fall_s = 1;
constexpr std::int64_t bin_us = 4'000;
constexpr std::int64_t bound_every_us = 4'000;
constexpr double bins_remembered = 40;
constexpr double more_than_noise = 1.4;
// A pixel, as it comes: blind for a ms after each event, pixels make 230 of 300 Hz.
constexpr double swamping_hz = 150;
constexpr double swamped_share = 0.25;
constexpr double surfaced_share = 0.5;
// A pixel. Where there is more, it is told whether it is steady.
constexpr double weak_hz = 5;
// Of contour, in half a second: a third of a px of way makes them. Fewer tell nothing, wherever
// they are: some may be of a pixel that fires by itself.
constexpr double few_per_px = 0.7;
constexpr double near_memory_events = 250;
constexpr double sudden = 3;  // times as many on the contour at once: an object sets out
const double log_more_than_noise = std::log(more_than_noise);
constexpr double surely = 12;  // a log likelihood

// Of the whole contour and of a part of it: what is told first, and how much is remembered.
constexpr double whole_first_events = 60;
constexpr double whole_window_events = 300;
constexpr double part_first_events = 60;
constexpr double part_window_events = 120;

}  // namespace

void Clutter::Part::forget() {
    far_events = {};
    near_events = own_events = events = 0;
    density = {floor, floor};
    own_share = 1;
    is_measured = false;
}

void Clutter::Part::close_window() {
    const double area_px2 = std::max(far_area_px2[0] + far_area_px2[1], 1.0);
    const double mean_density = (far_events[0] + far_events[1]) / area_px2;
    const double prior_px2 = 0.1 * area_px2;
    double clutter_on_contour = 0;
    std::array<double, 2> beside{};
    for (std::size_t side = 0; side < 2; ++side) {
        beside[side] =
            (far_events[side] + prior_px2 * mean_density) / (far_area_px2[side] + prior_px2);
        clutter_on_contour += beside[side] * near_width_px[side] * near_px;
    }
    // The shares of events told for clutter would keep them clutter for ever: what is plainly more
    // than the clutter beside it counts as well.
    const double plainly_own =
        near_events - clutter_on_contour - (is_measured ? std::sqrt(near_events) : 0);
    const double own = std::max({own_events, plainly_own, 0.05 * events});
    for (std::size_t side = 0; side < 2; ++side) {
        density[side] = std::max(floor, beside[side] * near_width_px[side] / own);
    }
    is_measured = true;
    own_share = std::clamp(1 - clutter_on_contour / std::max(near_events, 1.0), 0.0, 1.0);
    // Half of what was counted stays: the window slides.
    for (double& count : far_events) count *= 0.5;
    near_events *= 0.5;
    own_events *= 0.5;
    events *= 0.5;
}

void Clutter::restart() {
    whole_.forget();
    for (Part& part : parts_) part.forget();
    standing_density_ = {floor, floor};
    fresh_ = {};
    fresh_count_ = 0;
    for_more_ = for_noise_ = 0;
    is_noise_alone_ = is_quiet_ = is_swamped_ = is_steady_ = false;
    has_shown_more_ = false;
    most_near_hz_ = seen_ = 0;
    usual_near_hz_ = 0;
    bin_events_ = bin_mean_ = bin_variance_ = bins_ = 0;
    bin_end_us_ = 0;
    noise_on_contour_hz_ = noise_hz_ = counted_hz_ = 0;
    most_noise_hz_ = std::numeric_limits<double>::infinity();
    bounded_us_ = 0;
    remembered_ = 0;
    new_far_ = far_hz_ = {};
    new_near_ = near_hz_ = near_remembered_ = 0;
    near_count_ = near_began_us_ = slack_us_ = 0;
    folded_us_ = fold_at_us_ = last_near_us_ = due_us_ = t_us_ = 0;
    has_begun_ = false;
}

// By the normal that points away from the model's centre.
void Clutter::find_facings(const Contour& contour) {
    has_parts_ = contour.is_outline();
    for (const Piece& piece : contour.pieces().pieces()) {
        Eigen::Vector2d n(piece.by - piece.ay, piece.ax - piece.bx);
        const Eigen::Vector2d middle(piece.ax + piece.bx, piece.ay + piece.by);
        if (n.isZero()) n = middle;
        if (n.dot(middle) < 0) n = -n;
        const double turns = std::atan2(n.y(), n.x()) / (2 * std::numbers::pi) + 1;
        facing_.push_back(
            static_cast<std::uint8_t>(std::lround(turns * facings) % std::int64_t{facings}));
    }
}

void Clutter::sample(const Contour& contour, const Eigen::Matrix2d& a) {
    if (facing_.empty()) find_facings(contour);
    const ImageMetric metric(a);
    const Eigen::Matrix2d inverse = a.inverse();
    const double reach_px = contour.radius_px() * a.norm() + far_to_px + 1;
    const double step_px = std::max(1.0, reach_px / 128);
    for (Part& part : parts_) part.far_area_px2 = part.near_width_px = {};
    for (double y = -reach_px; y <= reach_px; y += step_px) {
        for (double x = -reach_px; x <= reach_px; x += step_px) {
            const Eigen::Vector2d image(x, y);
            const Eigen::Vector2d m = inverse * image;
            const auto nearest = contour.pieces().nearest(m.x(), m.y(), metric);
            if (nearest.piece < 0) continue;
            const double distance_px = std::sqrt(nearest.squared_px);
            if (distance_px > far_to_px) continue;
            const auto index = static_cast<std::size_t>(nearest.piece);
            const Piece& piece = contour.pieces().pieces()[index];
            const Eigen::Vector2d along =
                a * Eigen::Vector2d(piece.bx - piece.ax, piece.by - piece.ay);
            const Eigen::Vector2d from = image - a * Eigen::Vector2d(piece.ax, piece.ay);
            const double length_px = along.norm();
            const double r_px = length_px > 1e-9
                                    ? (along.y() * from.x() - along.x() * from.y()) / length_px
                                    : distance_px;
            // What is past a piece's end is not counted either.
            if (nearest.squared_px - r_px * r_px > overshoot_px * overshoot_px) continue;
            const bool side = r_px > 0;
            Part& part = parts_[facing_[index]];
            const double area_px2 = step_px * step_px;
            if (std::abs(r_px) < near_px) part.near_width_px[side] += area_px2 / near_px;
            if (std::abs(r_px) > far_from_px) part.far_area_px2[side] += area_px2;
        }
    }
    for (std::size_t side = 0; side < 2; ++side) {
        whole_.near_width_px[side] = whole_.far_area_px2[side] = 0;
        for (const Part& part : parts_) {
            whole_.near_width_px[side] += part.near_width_px[side];
            whole_.far_area_px2[side] += part.far_area_px2[side];
        }
        whole_.far_area_px2[side] = std::max(whole_.far_area_px2[side], 1.0);
    }
    set_steady(seems_steady());
}

void Clutter::count_far(std::int32_t piece, double r_px) {
    ++new_far_[r_px > 0];
    ++bin_events_;
    ++fresh_[facing_[static_cast<std::size_t>(piece)]].far[r_px > 0];
    if (++fresh_count_ == together) settle();
}

void Clutter::settle() {
    fresh_count_ = 0;
    for (std::size_t facing = 0; facing < facings; ++facing) {
        const Fresh fresh = std::exchange(fresh_[facing], {});
        const double events = fresh.near + fresh.far[0] + fresh.far[1];
        if (events == 0) continue;
        for (Part* counted : {&whole_, &parts_[facing]}) {
            counted->near_events += fresh.near;
            counted->own_events += fresh.own;
            counted->far_events[0] += fresh.far[0];
            counted->far_events[1] += fresh.far[1];
            counted->events += events;
        }
        parts_[facing].close_window_at(part_first_events, part_window_events);
    }
    whole_.close_window_at(whole_first_events, whole_window_events);
}

// Two sequential tests (Page's) of the rate on the contour: the noise's own, or 1.4 times as much.
void Clutter::weigh_noise() {
    const auto since_near_us = static_cast<double>(t_us_ - last_near_us_);
    const double more =
        log_more_than_noise - (more_than_noise - 1) * noise_on_contour_hz_ * since_near_us * 1e-6;
    for_more_ = std::max(for_more_ + more, 0.0);
    for_noise_ = std::max(for_noise_ - more, 0.0);
    if (is_noise_alone_ && for_more_ > surely) {
        is_noise_alone_ = false;
        for_noise_ = 0;
    } else if (!is_noise_alone_ && for_noise_ > surely) {
        is_noise_alone_ = true;
        for_more_ = 0;
    }
}

void Clutter::set_steady(bool is_steady) {
    is_steady_ = is_steady;
    if (is_steady) return;
    for_more_ = for_noise_ = 0;
    is_noise_alone_ = false;
}

void Clutter::catch_up() {
    if (!has_begun_) {
        has_begun_ = true;
        folded_us_ = last_near_us_ = t_us_;
        near_began_us_ = static_cast<double>(t_us_);
    }
    if (t_us_ >= bin_end_us_) close_bin(t_us_);
    if (t_us_ >= fold_at_us_ || near_time_us() > slack_us_) fold(t_us_);
    const auto slack_ends_us = static_cast<std::int64_t>(near_began_us_ + slack_us_) + 1;
    due_us_ = std::min({bin_end_us_, fold_at_us_, slack_ends_us});
}

void Clutter::close_bin(std::int64_t t_us) {
    const bool is_first = bin_end_us_ == 0;
    const std::int64_t missed_us = t_us - bin_end_us_;
    bin_end_us_ = t_us + bin_us;
    if (is_first || missed_us > bin_us) {  // A silence is no noise.
        bins_ = 0;
        bin_mean_ = bin_variance_ = bin_events_ = 0;
        most_noise_hz_ = std::numeric_limits<double>::infinity();
        bounded_us_ = 0;
        set_steady(false);
        return;
    }
    bins_ = std::min(bins_ + 1, bins_remembered);
    const double off = bin_events_ - bin_mean_;
    bin_mean_ += off / bins_;
    bin_variance_ += (off * (bin_events_ - bin_mean_) - bin_variance_) / bins_;
    bin_events_ = 0;
    set_steady(seems_steady());
}

std::int64_t Clutter::asks_for_noise_of_us(std::int64_t t_us) const {
    if (bins_ < 1 || bin_mean_ < few_events || t_us - bounded_us_ < bound_every_us) return 0;
    // In the time in which two of three pixels would have fired.
    return static_cast<std::int64_t>(
        std::min(bins_ * static_cast<double>(bin_us), 1e6 / std::max(noise_hz_, 1e-3)));
}

void Clutter::bound_noise(std::int64_t t_us, double most_hz) {
    bounded_us_ = t_us;
    most_noise_hz_ = most_hz;
    if (is_steady_) set_steady(seems_steady());
}

bool Clutter::seems_steady() const {
    if (!can_be_noise(counted_hz_)) return false;
    const double enough = bin_mean_ > many_events ? least_bins_of_many : least_bins;
    if (bins_ < enough || bin_mean_ < few_events) return false;
    const double left = far_hz_[0] * whole_.far_area_px2[1];
    const double right = far_hz_[1] * whole_.far_area_px2[0];
    return bin_variance_ < most_dispersion * bin_mean_ && left < most_uneven * right &&
           right < most_uneven * left;
}

void Clutter::fold(std::int64_t t_us) {
    const double dt_s = static_cast<double>(t_us - folded_us_) * 1e-6;
    folded_us_ = t_us;
    fold_at_us_ = t_us + fold_us;
    const double far_kept = std::exp(-dt_s / far_memory_s);
    const double near_hz = near_count_ / std::max(near_time_us(), 1.0) * 1e6;
    slack_us_ = 2 * near_time_us();
    usual_near_hz_ += (near_hz - usual_near_hz_) *
                      std::min(dt_s / (near_hz > usual_near_hz_ ? rise_s : fall_s), 1.0);
    is_quiet_ = near_hz < usual_near_hz_ / 4;
    // What the memory holds of the time since the restart.
    remembered_ = remembered_ * far_kept + (1 - far_kept);
    double clutter_hz = 0;
    std::array<double, 2> beside_hz{};  // on the contour, per px
    for (std::size_t side = 0; side < 2; ++side) {
        far_hz_[side] = far_hz_[side] * far_kept + new_far_[side] / far_memory_s;
        beside_hz[side] = far_hz_[side] / std::max(remembered_, 0.01) /
                          std::max(whole_.far_area_px2[side], 1.0) * whole_.near_width_px[side];
        clutter_hz += beside_hz[side] * near_px;
    }
    const double near_px2 = (whole_.near_width_px[0] + whole_.near_width_px[1]) * near_px;
    counted_hz_ = clutter_hz / std::max(near_px2, 1.0);
    set_steady(seems_steady());
    noise_hz_ = std::min(counted_hz_, most_noise_hz_);
    noise_on_contour_hz_ = noise_hz_ * near_px2;
    is_swamped_ = is_steady_ && noise_hz_ > (is_swamped_ ? 0.75 : 1) * swamping_hz &&
                  whole_.own_share < (is_swamped_ ? surfaced_share : swamped_share);
    const double own_hz = std::max({near_hz - clutter_hz, 0.1 * near_hz, 1e-3});
    for (std::size_t side = 0; side < 2; ++side) standing_density_[side] = beside_hz[side] / own_hz;
    const double near_kept =
        std::exp(-dt_s * std::max(1 / far_memory_s, usual_on_contour_hz() / near_memory_events));
    near_hz_ = near_hz_ * near_kept + new_near_ / std::max(dt_s, 1e-6) * (1 - near_kept);
    near_remembered_ = near_remembered_ * near_kept + (1 - near_kept);
    most_near_hz_ = 2 * weak_hz * near_px2;
    seen_ += new_near_ + new_far_[0] + new_far_[1];
    if (seen_ >= least_seen && !has_shown_more_) {
        has_shown_more_ = !seems_weak_noise(near_hz, clutter_hz);
    }
    new_far_ = {};
    new_near_ = 0;
}

bool Clutter::seems_weak_noise(double near_hz, double clutter_hz) const {
    const double left = far_hz_[0] * far_memory_s;
    const double right = far_hz_[1] * far_memory_s;
    const double beside = left + right;
    const double usual_hz = usual_on_contour_hz();
    const double length_px = (whole_.near_width_px[0] + whole_.near_width_px[1]) / 2;
    const double few = few_per_px * length_px;
    if (beside + usual_hz * far_memory_s < few && near_hz * far_memory_s < few) return true;
    // Of so few, three standard deviations are chance.
    const double left_share =
        whole_.far_area_px2[0] / (whole_.far_area_px2[0] + whole_.far_area_px2[1]);
    const double most_off = 3 * std::sqrt(beside * left_share * (1 - left_share));
    const double near = std::min(usual_hz * far_memory_s, near_memory_events) * remembered_;
    const double most =
        more_than_noise + 3 * std::sqrt(1 / std::max(near, 1.0) + 1 / std::max(beside, 1.0));
    return counted_hz_ < weak_hz && std::abs(left - beside * left_share) < most_off &&
           usual_hz < most * clutter_hz && near_hz < sudden * clutter_hz;
}

}  // namespace pursuit::tracker
