// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/supported_events.hpp"

#include <algorithm>
#include <cmath>

#include "services/tracker/core/occlusion.hpp"

namespace pursuit::tracker {
namespace {

constexpr std::int32_t never_us = std::int32_t{-1} << 30;  // before what is looked at

/// Whether it came from what lies over the object, where that was then.
bool is_of(std::span<const SupportedEvents::Cover> covers, const Event& event) {
    return std::any_of(covers.begin(), covers.end(), [&](const SupportedEvents::Cover& cover) {
        return cover.silhouette.depth_px(Eigen::Vector2d(event.x, event.y),
                                         cover.now.at(event.t_us, 1).pose) > -Occlusion::band_px;
    });
}

}  // namespace

// What lies a pixel farther out, and more, supports nothing that is in reach.
LastEvents::Box SupportedEvents::box_of(const Wish& wish) const {
    const auto within = [](double px, std::uint16_t end) {
        return static_cast<std::uint16_t>(std::clamp<double>(std::floor(px), 0, end));
    };
    const double side_px = wish.reach_px + 2;
    const Eigen::Vector2d& around_px = wish.around_px;
    return {within(around_px.x() - side_px, geometry_.width),
            within(around_px.y() - side_px, geometry_.height),
            within(around_px.x() + side_px + 1, geometry_.width),
            within(around_px.y() + side_px + 1, geometry_.height)};
}

void SupportedEvents::gather(std::int64_t t_us, LastEvents& last, const Wish& wish,
                             std::span<const Cover> covers) {
    events_.clear();
    neighbours_.clear();
    looked_at_.clear();
    const auto is_in_reach = [&](const Event& event) {
        return std::abs(event.x - wish.around_px.x()) < wish.reach_px &&
               std::abs(event.y - wish.around_px.y()) < wish.reach_px;
    };
    const LastEvents::Box box = box_of(wish);
    // Of the box and a rim about it, so that every pixel has its neighbours.
    const auto columns = static_cast<std::size_t>(box.right - box.left) + 2;
    const std::size_t pixels = columns * (static_cast<std::size_t>(box.bottom - box.top) + 2);
    if (fired_us_.size() < pixels) fired_us_.resize(pixels, never_us);
    chance_.begin(box.right - box.left, box.bottom - box.top);
    std::int64_t first_us = t_us;
    // Forwards, as they came: supported by a neighbour that fired shortly before.
    const auto neighbour_us = static_cast<std::int32_t>(wish.neighbour_us);
    std::int32_t* const fired_us = fired_us_.data();
    last.for_each_in(box, wish.since_us, [&, fired_us](const Event& event) {
        const std::size_t at = static_cast<std::size_t>(event.y - box.top + 1) * columns +
                               static_cast<std::size_t>(event.x - box.left + 1);
        const auto now_us = static_cast<std::int32_t>(event.t_us - wish.since_us);
        const std::int32_t after_us = now_us - neighbour_us;
        const auto fired_since = [&](std::size_t pixel) { return fired_us[pixel] > after_us; };
        int neighbours = fired_since(at - 1) + fired_since(at + 1);
        for (const std::size_t row : {at - columns, at + columns}) {
            neighbours += fired_since(row - 1) + fired_since(row) + fired_since(row + 1);
        }
        if (fired_us[at] == never_us) {
            chance_.add(event.x - box.left, event.y - box.top);
        }
        fired_us[at] = now_us;
        looked_at_.push_back(at);
        first_us = std::min(first_us, event.t_us);
        if (neighbours == 0 || !is_in_reach(event) || is_of(covers, event)) return;
        events_.push_back(event);
        neighbours_.push_back(static_cast<std::uint8_t>(neighbours));
    });
    for (const std::size_t pixel : looked_at_) fired_us_[pixel] = never_us;
    leave_out_noise(static_cast<double>(t_us - first_us), wish);
    supported_share_ = looked_at_.empty() ? 0
                                          : static_cast<double>(events_.size()) /
                                                static_cast<double>(looked_at_.size());
    if (events_.size() > wish.most) {
        events_.erase(events_.begin(), events_.end() - static_cast<std::ptrdiff_t>(wish.most));
    }
}

void SupportedEvents::leave_out_noise(double over_us, const Wish& wish) {
    const int least =
        chance_.least_neighbours(over_us, static_cast<double>(wish.neighbour_us), wish.noise_share);
    if (least == 1) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < events_.size(); ++i) {
        if (neighbours_[i] >= least) events_[kept++] = events_[i];
    }
    events_.resize(kept);
}

double SupportedEvents::mean_age_us(std::int64_t t_us) const {
    double sum_us = 0;
    for (const Event& event : events_) sum_us += static_cast<double>(t_us - event.t_us);
    return events_.empty() ? 0 : sum_us / static_cast<double>(events_.size());
}

}  // namespace pursuit::tracker
