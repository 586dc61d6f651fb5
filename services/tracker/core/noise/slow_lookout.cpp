// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/noise/slow_lookout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/tracker/core/noise/climb.hpp"

namespace pursuit::tracker {
namespace {

constexpr double most_samples = 64;
constexpr double longest_s = 1;
constexpr std::int64_t slice_us = 20'000;
constexpr double seen_beside_px = 5;  // of the contour: from farther not all events are asked for

// Without the best quarter of the contour.
constexpr std::size_t parts = 8;
constexpr std::size_t best_parts = 2;
constexpr double least_rest_z = 2;
constexpr double least_rest_share = 0.3;

// It makes no events while it stands, nor while it is too slow to make one in this time.
constexpr std::size_t stopped_slices = 2;

// Where it may be and how it may go, before that is moved uphill: so fast, and twice so where it
// turns; so far on the way or behind.
constexpr double creeping_px_s = 25;
constexpr double reach_px = 6;
constexpr double reach_step_px = 1.5;
constexpr int directions = 8;
constexpr std::size_t climbs = 3;

// The steps uphill; of the velocity as far as they take it in a third of the time looked at.
constexpr int most_rounds = 4;
constexpr double velocity_steps_per_s = 20;

// Whether m lies within the outlines.
bool is_inside(const std::vector<Piece>& pieces, const Eigen::Vector2d& m) {
    bool is_inside = false;
    for (const Piece& piece : pieces) {
        if ((piece.ay > m.y()) == (piece.by > m.y())) continue;
        const double along = (m.y() - piece.ay) / (piece.by - piece.ay);
        if (piece.ax + along * (piece.bx - piece.ax) > m.x()) is_inside = !is_inside;
    }
    return is_inside;
}

}  // namespace

SlowLookout::SlowLookout(const Contour& contour)
    : samples_(samples_along(contour, most_samples)), has_inside_(contour.is_outline()) {
    if (!has_inside_) return;
    for (ContourSample& sample : samples_) {
        if (is_inside(contour.pieces().pieces(), sample.at_px + 0.5 * sample.across)) {
            sample.across = -sample.across;
        }
    }
}

void SlowLookout::add(const FiredCounts& fired, const Eigen::Vector2d& middle_px,
                      double extent_px) {
    if (fired.side == 0) return;
    if (added_ == 0) {
        std::rotate(slices_.begin(), slices_.end() - 1, slices_.end());
        slices_[0].begin(fired);
    }
    slices_[0].add(fired);
    if (++added_ < together) return;
    added_ = 0;
    filled_ = std::min(filled_ + 1, slices);
    slices_[0].close(middle_px, extent_px + seen_beside_px);
}

// Samples next to each other have pixels in common.
void SlowLookout::weigh_overlap(const Pose& pose) {
    const FiredSlice& slice = slices_[0];
    std::vector<float> weights(slice.counts.size());
    for (const ContourSample& sample : samples_) {
        const Eigen::Vector2d p = pose.t_px + pose.a * sample.at_px;
        const int column = static_cast<int>(std::lround(p.x())) - slice.left;
        const int row = static_cast<int>(std::lround(p.y())) - slice.top;
        if (column < 1 || row < 1 || column >= slice.side - 1 || row >= slice.side - 1) continue;
        for (int y = -1; y <= 1; ++y) {
            for (int x = -1; x <= 1; ++x) {
                weights[slice.index(row + y, column + x)] +=
                    FiredSlice::across_px[static_cast<std::size_t>(y + 1)] *
                    FiredSlice::across_px[static_cast<std::size_t>(x + 1)];
            }
        }
    }
    double squares = 0;
    for (const float weight : weights) squares += static_cast<double>(weight) * weight;
    // Less than of a single sample where the contour lies beyond the window.
    constexpr double of_a_sample = 0.375 * 0.375;
    sample_variance_ = std::max(squares / static_cast<double>(samples_.size()), of_a_sample);
}

void SlowLookout::add_slice(std::size_t slice, const Coast& then, std::size_t first,
                            std::size_t end, Sums& sums) const {
    const Eigen::Matrix2d& a = then.pose.a;
    const double scale = std::sqrt(std::abs(a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0)));
    double weights2 = 0;
    for (std::size_t k = first; k < end; ++k) {
        const ContourSample& sample = samples_[k];
        const Eigen::Vector2d arm = a * sample.at_px;
        // The cofactors of A turn what is across, and make it longer by the scale or so.
        const Eigen::Vector2d n(a(1, 1) * sample.across.x() - a(1, 0) * sample.across.y(),
                                a(0, 0) * sample.across.y() - a(0, 1) * sample.across.x());
        const double across_px_s =
            (n.x() * (then.velocity.vx_px_s - then.velocity.omega_rad_s * arm.y()) +
             n.y() * (then.velocity.vy_px_s + then.velocity.omega_rad_s * arm.x())) /
            scale;
        const double weight = std::abs(across_px_s);
        const auto fired =
            slices_[slice].at(then.pose.t_px.x() + arm.x(), then.pose.t_px.y() + arm.y());
        auto& sum = sums.fired[across_px_s > 0];
        for (std::size_t polarity = 0; polarity < 2; ++polarity) {
            sum[polarity] += weight * fired[polarity];
        }
        weights2 += weight * weight;
    }
    sums.variance += weights2 * slices_[slice].mean * sample_variance_;
}

double SlowLookout::z_of(const Sums& of, const Sums& less) const {
    const double sigma = std::sqrt(std::max(of.variance - less.variance, 1e-9));
    const auto fired = [&](std::size_t outwards, std::size_t polarity) {
        return (of.fired[outwards][polarity] - less.fired[outwards][polarity]) / sigma;
    };
    const double bright = fired(0, 0) + fired(1, 1);
    const double dark = fired(0, 1) + fired(1, 0);
    const double any = (bright + dark) / std::numbers::sqrt2;
    return has_inside_ ? std::max({any, bright, dark}) : any;
}

// It may have gone so all the time, or until some slices ago, or in the newer half of it alone.
auto SlowLookout::told_by(const Coast& coast) const -> Told {
    std::array<Sums, slices + 1> since{};  // summed up from the oldest
    for (std::size_t i = filled_; i-- > 0;) {
        since[i] = since[i + 1];
        const auto age_us = static_cast<std::int64_t>(i) * slice_us + slice_us / 2;
        add_slice(i, coast.at(coast.t_us - age_us, longest_s), 0, samples_.size(), since[i]);
    }
    Told told;
    const auto tell = [&](std::size_t newest, std::size_t end) {
        const double z = z_of(since[newest], since[end]);
        if (z > told.z) told = {z, newest};
    };
    for (std::size_t newest = 0; newest + least_slices <= filled_; ++newest) tell(newest, filled_);
    if (filled_ >= 2 * least_slices) tell(0, filled_ / 2);
    return told;
}

// Whether what speaks for it comes from more than a quarter of the contour: an edge of something
// else, or of its own where it is not, lies along a part of it.
bool SlowLookout::is_all_around(const Coast& coast, const Told& told) const {
    std::array<Sums, parts> sums{};
    Sums all;
    for (std::size_t i = told.newest; i < filled_; ++i) {
        const auto age_us = static_cast<std::int64_t>(i) * slice_us + slice_us / 2;
        const Coast then = coast.at(coast.t_us - age_us, longest_s);
        for (std::size_t part = 0; part < parts; ++part) {
            add_slice(i, then, part * samples_.size() / parts, (part + 1) * samples_.size() / parts,
                      sums[part]);
        }
    }
    for (const Sums& part : sums) {
        for (std::size_t k = 0; k < 4; ++k) all.fired[k / 2][k % 2] += part.fired[k / 2][k % 2];
        all.variance += part.variance;
    }
    std::sort(sums.begin(), sums.end(),
              [](const Sums& l, const Sums& r) { return l.most() < r.most(); });
    Sums best;
    for (std::size_t part = parts - best_parts; part < parts; ++part) {
        for (std::size_t k = 0; k < 4; ++k) {
            best.fired[k / 2][k % 2] += sums[part].fired[k / 2][k % 2];
        }
        best.variance += sums[part].variance;
    }
    return z_of(all, best) > std::max(least_rest_z, least_rest_share * told.z);
}

// On the way as of the last look first; or on another.
void SlowLookout::find_starts(const Coast& own) {
    starts_.clear();
    const Coast last = way_.value_or(own).at(own.t_us, longest_s);
    starts_.emplace_back(told_by(last).z, last);
    const auto consider = [&](const Velocity& velocity, double ahead_s) {
        Coast start = own;
        start.velocity = velocity;
        start = start.at(own.t_us + std::llround(ahead_s * 1e6), longest_s);
        start.t_us = own.t_us;
        starts_.emplace_back(told_by(start).z, start);
    };
    for (double ahead_px = -reach_px; ahead_px <= reach_px; ahead_px += reach_step_px) {
        for (const double px_s :
             {-2 * creeping_px_s, -creeping_px_s, creeping_px_s, 2 * creeping_px_s}) {
            Velocity turning;
            turning.omega_rad_s = px_s * turn_rad_;
            consider(turning, ahead_px / std::abs(px_s));
        }
        for (int i = 0; i < directions; ++i) {
            const double angle_rad = 2 * std::numbers::pi * i / directions;
            Velocity straight;
            straight.vx_px_s = creeping_px_s * std::cos(angle_rad);
            straight.vy_px_s = creeping_px_s * std::sin(angle_rad);
            consider(straight, ahead_px / creeping_px_s);
        }
    }
    std::stable_sort(starts_.begin() + 1, starts_.end(),
                     [](const auto& l, const auto& r) { return l.first > r.first; });
}

Coast SlowLookout::uphill(const Coast& coast, double& z) const {
    return climb(coast, z, {most_rounds, velocity_steps_per_s, turn_rad_},
                 [this](const Coast& moved) { return told_by(moved).z; });
}

auto SlowLookout::look(const Coast& own, double gyration_px) -> Sight {
    Sight sight{own, 0};
    if (samples_.empty() || filled_ < least_slices) return sight;
    turn_rad_ = 1 / std::max(gyration_px, 1.0);
    weigh_overlap(own.pose);
    find_starts(own);
    for (std::size_t i = 0; i < std::min(climbs, starts_.size()); ++i) {
        double z = starts_[i].first;
        const Coast coast = uphill(starts_[i].second, z);
        if (i > 0 && z <= sight.z) continue;
        sight.z = z;
        way_ = coast;
    }
    // What has made no events for a while stands where it made the last.
    const Told told = told_by(*way_);
    const std::size_t silent = told.newest;
    sight.is_all_around = is_all_around(*way_, told);
    sight.best = way_->at(own.t_us - static_cast<std::int64_t>(silent) * slice_us, longest_s);
    sight.best.t_us = own.t_us;
    if (silent >= stopped_slices) sight.best.velocity = {};
    return sight;
}

}  // namespace pursuit::tracker
