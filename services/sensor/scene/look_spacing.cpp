// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/look_spacing.hpp"

#include <algorithm>

#include "services/sensor/scene/gaussian_coverage.hpp"
#include "services/sensor/scene/look_plan.hpp"

namespace pursuit::sensor {

std::uint32_t LookSpacing::looks_without_event(const ActivePixels::Pixel& pixel,
                                               const Nearness& nearness, float room,
                                               float unknown_sigmas) const {
    const auto stride =
        static_cast<std::uint32_t>(1 / std::max(pixel.normal_share, 1.0F / greatest_stride));
    if (room <= 0) return stride;
    const auto& gaussian = GaussianCoverage::tables();
    constexpr auto most = static_cast<float>(LookPlan::greatest_skip);
    const auto looks = [&](float contrast, float distance, float way_a_look) {
        const float share = room / contrast + gaussian.tail(distance);
        return share >= 1 ? most : (distance - gaussian.distance(share)) / way_a_look;
    };
    const auto [nearest, count] = nearness;
    float safe = std::min(
        most,
        looks(1, std::min(unknown_sigmas, std::max(nearest, ImageEdges::cut_sigmas)), way_sigmas_));
    if (count > 0) {
        const float contrast = std::max(pixel.contrast, 1e-3F) * static_cast<float>(count);
        safe = std::min(
            safe, looks(contrast, nearest, way_sigmas_ * std::max(pixel.normal_share, 0.01F)));
    }
    return std::max(static_cast<std::uint32_t>(std::max(safe, 0.0F)), stride);
}

}  // namespace pursuit::sensor
