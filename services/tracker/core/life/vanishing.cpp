// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/vanishing.hpp"

#include <algorithm>
#include <cmath>

namespace pursuit::tracker {
namespace {

// What is this deep inside has no part in the events of the contour; of narrow shapes the next is
// taken. Less than so much of it, in the image, tells nothing.
constexpr double margins_px[] = {3, 2};
constexpr double least_inside_px2 = 60;
constexpr double about_from_px = 2.5;
constexpr double about_to_px = 4;  // beyond the farthest point: what is farther, nobody asks about
constexpr double least_about_px2 = 60;
// Where the image shows it smaller, the margin is none.
constexpr double least_scale2 = 0.5;

constexpr double most_map_columns = 256;

// A cell has fired when this share of its pixels has, beside what is usual there.
constexpr double fired_share = 0.4;
constexpr double beyond_noise = 2;  // σ
constexpr int fired_cells = 10;

// More than a third of the inside: another shape in its place covers some of it. (Of scenes of
// which all stay that are there, none has two cells that fire at once.)
constexpr int changed_cells = 6;

// Of a flicker of the light; and of the variance of the times that an edge passing explains.
constexpr double most_about = 0.4;
constexpr double most_passing = 0.5;

// What is usual is over this many bins, and known after so long.
constexpr double usual_bins = 16;
constexpr std::int64_t learnt_us = 25'000;

// So much of its own events, and at least so many, and it is still there.
constexpr double own_share = 0.35;
constexpr double least_own = 8;

}  // namespace

Vanishing::Vanishing(const Silhouette& silhouette, double radius_px) {
    if (silhouette.covers_nothing()) return;
    const double about_end_px = radius_px + about_to_px;
    const double inner_columns = std::min(std::ceil(2 * about_end_px), most_map_columns);
    columns_ = static_cast<std::size_t>(inner_columns) + 2;  // with a rim that is nowhere
    cells_per_px_ = inner_columns / (2 * about_end_px);
    middle_ = static_cast<double>(columns_) / 2;
    // A cell reaches no farther from its own centre than this.
    constexpr double half_diagonal = 0.75;
    const double farthest_cells = about_end_px * cells_per_px_ + half_diagonal;
    farthest2_cells2_ = farthest_cells * farthest_cells;
    reach_px_ = farthest_cells / cells_per_px_;
    map_.assign(columns_ * columns_, nowhere);
    const double place_px2 = 1 / (cells_per_px_ * cells_per_px_);

    std::vector<float> depth_px(map_.size());
    for (std::size_t i = 0; i < map_.size(); ++i) {
        const auto column = static_cast<double>(i % columns_);
        const auto row = static_cast<double>(i / columns_);
        const Eigen::Vector2d place_px((column + 0.5 - middle_) / cells_per_px_,
                                       (row + 0.5 - middle_) / cells_per_px_);
        depth_px[i] = static_cast<float>(silhouette.depth_px(place_px));
        if (depth_px[i] < -about_from_px && place_px.norm() < about_end_px) {
            map_[i] = about;
            about_px2_ += place_px2;
        }
    }
    for (const double margin_px : margins_px) {
        std::vector<std::size_t> inside;
        for (std::size_t i = 0; i < map_.size(); ++i) {
            if (depth_px[i] > margin_px) inside.push_back(i);
        }
        const double inside_px2 = static_cast<double>(inside.size()) * place_px2;
        if (inside_px2 < least_inside_px2 || about_px2_ < least_about_px2) continue;
        divide(inside, 0, inside.size(), 0, cells);
        inside_px2_ = inside_px2;
        return;
    }
}

// The inside in halves across its longer side, again and again: cells of one size.
void Vanishing::divide(std::vector<std::size_t>& places, std::size_t first, std::size_t last,
                       std::size_t cell, std::size_t count) {
    if (count == 1) {
        for (std::size_t i = first; i < last; ++i) {
            map_[places[i]] = static_cast<std::uint8_t>(cell);
        }
        cell_px2_[cell] = static_cast<double>(last - first) / (cells_per_px_ * cells_per_px_);
        return;
    }
    const auto column = [&](std::size_t i) { return i % columns_; };
    std::size_t left = columns_;
    std::size_t right = 0;
    std::size_t top = columns_;
    std::size_t bottom = 0;
    for (std::size_t i = first; i < last; ++i) {
        left = std::min(left, column(places[i]));
        right = std::max(right, column(places[i]));
        top = std::min(top, places[i] / columns_);
        bottom = std::max(bottom, places[i] / columns_);
    }
    const bool is_wide = right + top > left + bottom;
    const auto begin = places.begin();
    const auto at = [&](std::size_t i) { return begin + static_cast<std::ptrdiff_t>(i); };
    std::sort(at(first), at(last), [&](std::size_t a, std::size_t b) {
        return is_wide && column(a) != column(b) ? column(a) < column(b) : a < b;
    });
    const std::size_t middle = (first + last) / 2;
    divide(places, first, middle, cell, count / 2);
    divide(places, middle, last, cell + count / 2, count / 2);
}

void Vanishing::restart() {
    began_us_ = suspected_us_ = changed_us_ = -1;
    bin_end_us_ = 0;
    bins_ = 0;
    inside_ = {};
    about_ = own_ = {};
    sums_now_ = sums_before_ = {};
    fired_ = 0;
}

void Vanishing::next_bin(std::int64_t t_us) {
    if (began_us_ < 0) {
        began_us_ = t_us;
        bin_end_us_ = t_us + bin_us;
        return;
    }
    const std::int64_t ended = (t_us - bin_end_us_) / bin_us + 1;
    bin_end_us_ += ended * bin_us;
    // In bins without events, and then in none for long, what is usual is known to be nothing.
    for (std::int64_t i = std::min<std::int64_t>(ended, 100); i > 0; --i) {
        // While it is suspected, what is usual is what was usual before.
        const double part = is_suspected() ? 0 : 1 / std::min(++bins_, usual_bins);
        const auto step = [&](Count& count) {
            count.usual += (count.before - count.usual) * part;
            count.before = count.now;
            count.now = 0;
        };
        for (Count& cell : inside_) step(cell);
        step(about_);
        step(own_);
        sums_before_ = sums_now_;
        sums_now_ = {};
    }
    fired_ = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) mark(cell);
}

void Vanishing::mark(std::size_t cell) {
    const Count& count = inside_[cell];
    const double more = count.more() - fired_share * cell_px2_[cell] * image_per_model2_;
    if (more > 0 && more * more > beyond_noise * beyond_noise * 2 * count.usual) {
        fired_ |= 1U << cell;
    }
}

// Of the variance of the times, what a plane over the places explains. What passes has an edge on
// either side, with as many offsets as polarities.
double Vanishing::share_of_passing() const {
    double xx = 0, xy = 0, yy = 0, xt = 0, yt = 0, tt = 0;
    for (std::size_t polarity = 0; polarity < 2; ++polarity) {
        const Sums& a = sums_now_[polarity];
        const Sums& b = sums_before_[polarity];  // in its own bin's time
        const auto back = static_cast<double>(bin_us);
        const double n = a.n + b.n;
        if (n < 1) continue;
        const double x = (a.x + b.x) / n;
        const double y = (a.y + b.y) / n;
        const double t = (a.t + b.t - back * b.n) / n;
        xx += a.xx + b.xx - n * x * x;
        xy += a.xy + b.xy - n * x * y;
        yy += a.yy + b.yy - n * y * y;
        xt += a.xt + b.xt - back * b.x - n * x * t;
        yt += a.yt + b.yt - back * b.y - n * y * t;
        tt += a.tt + b.tt - 2 * back * b.t + back * back * b.n - n * t * t;
    }
    const double determinant = xx * yy - xy * xy;
    // Of places in a line nothing can be told, nor of times that are one.
    if (determinant < 1e-6 * xx * yy || tt < 1) return 0;
    return (yy * xt * xt - 2 * xy * xt * yt + xx * yt * yt) / (determinant * tt);
}

bool Vanishing::is_of_object() const {
    double inside = 0;
    for (const Count& cell : inside_) inside += cell.more();
    return about_.more() / about_px2_ < most_about * inside / inside_px2_ &&
           share_of_passing() < most_passing;
}

void Vanishing::note(const Event& event, std::uint8_t cell, const Eigen::Vector2d& place,
                     double image_per_model2) {
    const std::int64_t t_us = event.t_us;
    reach(t_us);
    if (cell == about) {
        about_.now += 1;
    } else {
        inside_[cell].now += 1;
        const double t = static_cast<double>(t_us - (bin_end_us_ - bin_us));
        Sums& s = sums_now_[event.polarity & 1U];
        s.n += 1;
        s.x += place.x();
        s.y += place.y();
        s.t += t;
        s.xx += place.x() * place.x();
        s.xy += place.x() * place.y();
        s.yy += place.y() * place.y();
        s.xt += place.x() * t;
        s.yt += place.y() * t;
        s.tt += t * t;
        image_per_model2_ = image_per_model2;
        mark(cell);
    }
    if (is_suspected()) {
        if (t_us < suspected_us_ + bin_us && !is_of_object()) suspected_us_ = -1;
        return;
    }
    const int fired = std::popcount(fired_);
    if (cell == about || fired < changed_cells) return;
    if (t_us - began_us_ < learnt_us || image_per_model2 < least_scale2) return;
    if (share_of_passing() >= most_passing) return;
    // Until it changes no more: of what the last of it did, what comes is to be told.
    changed_us_ = t_us;
    since_.restart();
    if (fired < fired_cells || !is_of_object()) return;
    suspected_us_ = t_us;
    own_since_ = own_variance_ = 0;
    needed_ = std::max(least_own, own_share * std::max(own_.usual, 0.0) *
                                      static_cast<double>((verdict_us - window_us) / bin_us));
}

}  // namespace pursuit::tracker
