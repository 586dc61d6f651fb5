// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/extraction/dominant_motion.hpp"

#include <array>
#include <vector>

namespace pursuit::ctl {
namespace {

constexpr int reach_px = 16;
constexpr std::size_t enough_events = 20'000;  // more make the search slower, not surer
constexpr float needed_gain = 1.1F;

/// The image of moved-back events, one layer a polarity.
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
        origin_ = low.array() - (reach_px / 2 + 4);
        const Eigen::Vector2f extent = high - low;
        for (auto& layer : layers_) {
            layer.resize(static_cast<int>(extent.y()) + reach_px + 9,
                         static_cast<int>(extent.x()) + reach_px + 9);
        }
    }

    /// Counts by pixel: quick, and blunt, since pixels round.
    float count(const Eigen::Vector2f& motion_px) {
        clear();
        for (const auto& event : events_) {
            const Eigen::Vector2f place = moved(event, motion_px).array() + 0.5F;
            layers_[event.polarity & 1](static_cast<int>(place.y()), static_cast<int>(place.x())) +=
                1;
        }
        return sum_of_squares();
    }

    /// Each event as a bell that is as wide wherever it lies in its pixel (a quadratic B-spline,
    /// and 1-2-1 after it): one that is narrower in the middle of pixels favours what moves events
    /// from row to row least, and finds no motion of less than a pixel or two.
    float smooth(const Eigen::Vector2f& motion_px) {
        clear();
        for (const auto& event : events_) {
            const Eigen::Vector2f place = moved(event, motion_px);
            const Eigen::Vector2f pixel = (place.array() + 0.5F).floor();
            const auto across = spline(place.x() - pixel.x());
            const auto down = spline(place.y() - pixel.y());
            layers_[event.polarity & 1].block<3, 3>(static_cast<int>(pixel.y()) - 1,
                                                    static_cast<int>(pixel.x()) - 1) +=
                (down * across.transpose()).array();
        }
        for (auto& layer : layers_) {
            const auto rows = layer.rows() - 2;
            const auto columns = layer.cols() - 2;
            layer.middleRows(1, rows) =
                (layer.topRows(rows) + 2 * layer.middleRows(1, rows) + layer.bottomRows(rows))
                    .eval() /
                4;
            layer.middleCols(1, columns) =
                (layer.leftCols(columns) + 2 * layer.middleCols(1, columns) +
                 layer.rightCols(columns))
                    .eval() /
                4;
        }
        return sum_of_squares();
    }

 private:
    Eigen::Vector2f moved(const MovedEvent& event, const Eigen::Vector2f& motion_px) const {
        return event.position_px - event.phase * motion_px - origin_;
    }
    /// Shares of the pixel before, its own and the next, of what lies -0.5 … 0.5 px off the middle.
    static Eigen::Vector3f spline(float off_px) {
        const float before = 0.5F - off_px;
        const float after = 0.5F + off_px;
        return {before * before / 2, 0.75F - off_px * off_px, after * after / 2};
    }
    void clear() {
        for (auto& layer : layers_) layer.setZero();
    }
    float sum_of_squares() const { return layers_[0].square().sum() + layers_[1].square().sum(); }

    std::vector<MovedEvent> events_;
    Eigen::Vector2f origin_;
    std::array<Eigen::ArrayXXf, 2> layers_;
};

}  // namespace

Eigen::Vector2f dominant_motion_px(std::span<const MovedEvent> events) {
    if (events.empty()) return Eigen::Vector2f::Zero();
    Stack stack(events);
    const auto search = [&](Eigen::Vector2f& best_px, float step_px, int steps, auto measure) {
        const Eigen::Vector2f around = best_px;
        float best = measure(best_px);
        for (int y = -steps; y <= steps; ++y) {
            for (int x = -steps; x <= steps; ++x) {
                const Eigen::Vector2f motion_px =
                    around +
                    step_px * Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y));
                if (motion_px.cwiseAbs().maxCoeff() > reach_px) continue;
                const float sum = measure(motion_px);
                if (sum > best) {
                    best = sum;
                    best_px = motion_px;
                }
            }
        }
    };
    const auto count = [&](const Eigen::Vector2f& motion_px) { return stack.count(motion_px); };
    const auto smooth = [&](const Eigen::Vector2f& motion_px) { return stack.smooth(motion_px); };
    Eigen::Vector2f best_px = Eigen::Vector2f::Zero();
    search(best_px, 1, reach_px, count);
    if (count(best_px) < needed_gain * count(Eigen::Vector2f::Zero())) {
        return Eigen::Vector2f::Zero();
    }
    search(best_px, 1, 1, smooth);
    search(best_px, 0.5F, 1, smooth);
    search(best_px, 0.25F, 1, smooth);
    search(best_px, 0.125F, 1, smooth);
    search(best_px, 0.0625F, 1, smooth);
    return best_px;
}

}  // namespace pursuit::ctl
