// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/extraction/dominant_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pursuit::ctl {
namespace {

constexpr int reach_px = 16;
constexpr std::size_t enough_events = 20'000;  // more make the search slower, not surer
constexpr double needed_gain = 1.1;

/// Counts of moved-back events, one layer a polarity.
class Stack {
 public:
    explicit Stack(std::span<const MovedEvent> events) {
        const std::size_t stride = events.size() / enough_events + 1;
        Eigen::Vector2f low = events.front().position_px;
        Eigen::Vector2f high = low;
        for (std::size_t i = 0; i < events.size(); i += stride) {
            events_.push_back(events[i]);
            low = low.cwiseMin(events[i].position_px);
            high = high.cwiseMax(events[i].position_px);
        }
        // An event moves by at most half the displacement to either side.
        origin_ = low.array() - (reach_px / 2 + 2);
        width_ = static_cast<int>(high.x() - low.x()) + reach_px + 5;
        height_ = static_cast<int>(high.y() - low.y()) + reach_px + 5;
        counts_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 2);
    }

    double sum_of_squares(const Eigen::Vector2f& motion_px) {
        std::fill(counts_.begin(), counts_.end(), 0);
        std::int64_t sum = 0;
        for (const auto& event : events_) {
            const Eigen::Vector2f place = event.position_px - event.phase * motion_px - origin_;
            const int x = static_cast<int>(place.x() + 0.5F);
            const int y = static_cast<int>(place.y() + 0.5F);
            auto& count = counts_[static_cast<std::size_t>((y * width_ + x) * 2 + event.polarity)];
            sum += 2 * count + 1;  // (n + 1)² - n²
            ++count;
        }
        return static_cast<double>(sum);
    }

 private:
    std::vector<MovedEvent> events_;
    Eigen::Vector2f origin_;
    int width_ = 0;
    int height_ = 0;
    std::vector<std::int32_t> counts_;
};

}  // namespace

Eigen::Vector2f dominant_motion_px(std::span<const MovedEvent> events) {
    if (events.empty()) return Eigen::Vector2f::Zero();
    Stack stack(events);
    const double still = stack.sum_of_squares(Eigen::Vector2f::Zero());
    Eigen::Vector2f best_px = Eigen::Vector2f::Zero();
    double best = still;
    const auto consider = [&](const Eigen::Vector2f& motion_px) {
        if (motion_px.cwiseAbs().maxCoeff() > reach_px) return;
        const double sum = stack.sum_of_squares(motion_px);
        if (sum > best) {
            best = sum;
            best_px = motion_px;
        }
    };
    for (int y = -reach_px; y <= reach_px; ++y) {
        for (int x = -reach_px; x <= reach_px; ++x) {
            consider({static_cast<float>(x), static_cast<float>(y)});
        }
    }
    for (const float step_px : {0.5F, 0.25F}) {
        const Eigen::Vector2f around = best_px;
        for (int y = -1; y <= 1; ++y) {
            for (int x = -1; x <= 1; ++x) {
                consider(around +
                         step_px * Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)));
            }
        }
    }
    return best >= needed_gain * still ? best_px : Eigen::Vector2f::Zero();
}

}  // namespace pursuit::ctl
