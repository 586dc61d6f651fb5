// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/filter_switch.hpp"

#include <utility>

namespace pursuit::sensor {

Result<std::unique_ptr<FilterSwitch>> FilterSwitch::make(std::vector<FilterSetting> settings) {
    if (auto ok = FilterChain::check(settings); !ok) return tl::unexpected(ok.error());
    return std::unique_ptr<FilterSwitch>(new FilterSwitch(std::move(settings)));
}

Result<void> FilterSwitch::set(std::vector<FilterSetting> settings) {
    const std::scoped_lock lock(mutex_);
    if (auto ok = FilterChain::check(settings); !ok) return ok;
    if (input_ != Geometry{}) {
        auto chain = FilterChain::make(settings, input_);
        if (!chain) return tl::unexpected(chain.error());
        next_ = std::move(*chain);
        changed_ = true;
    }
    settings_ = std::move(settings);
    return {};
}

Result<std::unique_ptr<FilterChain>> FilterSwitch::begin(Geometry input) {
    const std::scoped_lock lock(mutex_);
    auto chain = FilterChain::make(settings_, input);
    if (chain) {
        input_ = input;
        next_.reset();
        changed_ = false;
    }
    return chain;
}

std::unique_ptr<FilterChain> FilterSwitch::take() {
    if (!changed_.load(std::memory_order_acquire)) return nullptr;
    // While another chain is being made the one in force goes on.
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return nullptr;
    changed_ = false;
    return std::move(next_);
}

std::string FilterSwitch::names() const {
    const std::scoped_lock lock(mutex_);
    std::string text;
    for (const auto& setting : settings_) text += (text.empty() ? "" : ", ") + setting.filter;
    return text;
}

}  // namespace pursuit::sensor
