// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/extraction/edge_points.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "services/ctl/extraction/event_cells.hpp"

namespace pursuit::ctl {
namespace {

constexpr float ridge_sigma_px = 0.8F;
constexpr int ridge_steps = 2;
constexpr std::size_t least_neighbours = 3;

float weight(const Eigen::Vector2f& distance_px) {
    return std::exp(-distance_px.squaredNorm() / (2 * ridge_sigma_px * ridge_sigma_px));
}

std::vector<Eigen::Vector2f> without_isolated(std::span<const Eigen::Vector2f> events_px) {
    const EventCells pixels(events_px);
    std::vector<std::size_t> counts;
    for (const auto& event : events_px) counts.push_back(pixels.neighbours(event));
    auto sorted = counts;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const auto least = std::max(least_neighbours, *middle / 4);
    std::vector<Eigen::Vector2f> kept;
    for (std::size_t i = 0; i < events_px.size(); ++i) {
        if (counts[i] >= least) kept.push_back(events_px[i]);
    }
    return kept;
}

/// Of a pixel, the smaller eigenvalue of Σ∇d∇dᵀ over 5×5 pixels (Shi and Tomasi, CVPR 1994).
class CornerMeasure {
 public:
    explicit CornerMeasure(const EventCells& pixels) : pixels_(pixels) {
        density_.resize(static_cast<std::size_t>(pixels.width() * pixels.height()));
        for (int y = 0; y < pixels.height(); ++y) {
            for (int x = 0; x < pixels.width(); ++x) {
                density_[pixels.index(x, y)] =
                    static_cast<float>(pixels.events(pixels.index(x, y)).size());
            }
        }
    }

    float at(const Eigen::Vector2f& position_px) const {
        Eigen::Matrix2f tensor = Eigen::Matrix2f::Zero();
        const int centre_x = pixels_.x_of(position_px);
        const int centre_y = pixels_.y_of(position_px);
        for (int y = centre_y - 2; y <= centre_y + 2; ++y) {
            for (int x = centre_x - 2; x <= centre_x + 2; ++x) {
                const Eigen::Vector2f gradient(smooth(x + 1, y, false) - smooth(x - 1, y, false),
                                               smooth(x, y + 1, true) - smooth(x, y - 1, true));
                tensor += gradient * gradient.transpose();
            }
        }
        const float half_trace = tensor.trace() / 2;
        const float determinant = tensor.determinant();
        return half_trace - std::sqrt(std::max(0.0F, half_trace * half_trace - determinant));
    }

 private:
    float density(int x, int y) const {
        if (x < 0 || y < 0 || x >= pixels_.width() || y >= pixels_.height()) return 0;
        return density_[pixels_.index(x, y)];
    }

    /// 1-2-1 across the direction of the difference, as Sobel's filter.
    float smooth(int x, int y, bool along_x) const {
        const int dx = along_x ? 1 : 0;
        const int dy = along_x ? 0 : 1;
        return (density(x - dx, y - dy) + 2 * density(x, y) + density(x + dx, y + dy)) / 4;
    }

    const EventCells& pixels_;
    std::vector<float> density_;
};

}  // namespace

bool ranks_before(const EdgePoint& l, const EdgePoint& r) {
    return std::tuple(-l.density, l.position_px.y(), l.position_px.x(), l.polarity) <
           std::tuple(-r.density, r.position_px.y(), r.position_px.x(), r.polarity);
}

std::vector<EdgePoint> edge_points(std::span<const Eigen::Vector2f> events_px,
                                   std::uint8_t polarity) {
    if (events_px.empty()) return {};
    auto kept = without_isolated(events_px);
    if (kept.empty()) return {};
    // One order for the sums below, whatever the order of the events.
    std::sort(kept.begin(), kept.end(), [](const Eigen::Vector2f& l, const Eigen::Vector2f& r) {
        return std::tuple(l.y(), l.x()) < std::tuple(r.y(), r.x());
    });
    const EventCells pixels(kept);
    const CornerMeasure corner(pixels);
    std::vector<EdgePoint> points;
    for (int y = 0; y < pixels.height(); ++y) {
        for (int x = 0; x < pixels.width(); ++x) {
            const auto& inside = pixels.events(pixels.index(x, y));
            if (inside.empty()) continue;
            Eigen::Vector2f position = Eigen::Vector2f::Zero();
            for (const auto& event : inside) position += event;
            position /= static_cast<float>(inside.size());
            float density = 0;
            // Mean shift: a few steps reach the ridge and do not yet run along it.
            for (int step = 0; step < ridge_steps; ++step) {
                Eigen::Vector2f sum = Eigen::Vector2f::Zero();
                density = 0;
                pixels.each_around(position, 2, [&](const Eigen::Vector2f& event) {
                    const float w = weight(event - position);
                    sum += w * event;
                    density += w;
                });
                position = sum / density;
            }
            points.push_back({position, density, corner.at(position), polarity});
        }
    }
    std::sort(points.begin(), points.end(), ranks_before);
    return points;
}

}  // namespace pursuit::ctl
