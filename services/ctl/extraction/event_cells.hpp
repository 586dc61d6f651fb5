// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>
#include <vector>

namespace pursuit::ctl {

/// Events by the pixel they lie in, with a margin of 3 pixels around all; at least one event.
class EventCells {
 public:
    explicit EventCells(std::span<const Eigen::Vector2f> events_px) {
        Eigen::Vector2f low = events_px.front();
        Eigen::Vector2f high = low;
        for (const auto& event : events_px) {
            low = low.cwiseMin(event);
            high = high.cwiseMax(event);
        }
        low_x_ = static_cast<int>(std::floor(low.x())) - 3;
        low_y_ = static_cast<int>(std::floor(low.y())) - 3;
        width_ = static_cast<int>(std::ceil(high.x())) + 5 - low_x_;
        height_ = static_cast<int>(std::ceil(high.y())) + 5 - low_y_;
        events_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
        for (const auto& event : events_px) events_[index_of(event)].push_back(event);
    }

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * width_ + x); }
    std::size_t index_of(const Eigen::Vector2f& at) const { return index(x_of(at), y_of(at)); }
    int x_of(const Eigen::Vector2f& at) const { return nearest(at.x()) - low_x_; }
    int y_of(const Eigen::Vector2f& at) const { return nearest(at.y()) - low_y_; }
    const std::vector<Eigen::Vector2f>& events(std::size_t index) const { return events_[index]; }

    std::size_t neighbours(const Eigen::Vector2f& at) const {
        std::size_t count = 0;
        each_around(at, 1, [&](const Eigen::Vector2f&) { ++count; });
        return count - 1;
    }

    /// Hands every event to `take` that lies in the (2·reach + 1)² pixels around a place; places
    /// within the events' extent, reach at most 2.
    template <class Take>
    void each_around(const Eigen::Vector2f& at, int reach, Take take) const {
        for (int y = y_of(at) - reach; y <= y_of(at) + reach; ++y) {
            for (int x = x_of(at) - reach; x <= x_of(at) + reach; ++x) {
                for (const auto& event : events_[index(x, y)]) take(event);
            }
        }
    }

 private:
    static int nearest(float value) { return static_cast<int>(std::lround(value)); }

    int low_x_ = 0;
    int low_y_ = 0;
    int width_ = 0;
    int height_ = 0;
    std::vector<std::vector<Eigen::Vector2f>> events_;
};

}  // namespace pursuit::ctl
