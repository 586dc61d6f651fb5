// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/look_plan.hpp"

#include <algorithm>

namespace pursuit::sensor {

void LookPlan::restart(const std::vector<ActivePixels::Pixel>& active_pixels) {
    for (auto& look : plan_) look.clear();
    for (std::uint32_t i = 0; i < active_pixels.size(); ++i) {
        put(i, std::max(next_look_[active_pixels[i].index], look_ + 1));
    }
}

void LookPlan::forget() { std::fill(next_look_.begin(), next_look_.end(), look_); }

const std::vector<std::uint32_t>& LookPlan::begin_look() {
    ++look_;
    looking_.clear();
    looking_.swap(plan_[look_ % plan_.size()]);
    return looking_;
}

}  // namespace pursuit::sensor
