// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/store_differences.hpp"

#include <algorithm>
#include <cstdio>
#include <span>

namespace pursuit::tracker {
namespace {

/// A pose that went through a file may have lost its last bits.
constexpr double same_px = 1e-6;
constexpr double same_map = 1e-9;

bool same_start(const Start& configured, const Start& stored, TransformKind transform) {
    if (configured.search || stored.search) return configured.search == stored.search;
    const Pose pose = constrained(configured.pose, transform);
    return (pose.t_px - stored.pose.t_px).norm() < same_px &&
           (pose.a - stored.pose.a).norm() < same_map && configured.velocity == stored.velocity;
}

void add(std::string& text, const std::string& what) {
    if (!text.empty()) text += ", ";
    text += what;
}

/// Of the stored values those that are configured otherwise.
void add_values(std::string& text, std::span<const NamedValue> configured,
                std::span<const NamedValue> stored) {
    for (const auto& [name, value] : stored) {
        const auto other =
            std::find_if(configured.begin(), configured.end(),
                         [&, &wanted = name](const auto& each) { return each.name == wanted; });
        if (other == configured.end() || other->value == value) continue;
        char numbers[80];
        std::snprintf(numbers, sizeof numbers, " %g instead of %g", value, other->value);
        add(text, name + numbers);
    }
}

}  // namespace

std::string differences(const Registration& configured, const RegisteredObject& stored,
                        const ObjectParameters& new_objects) {
    std::string text;
    if (centred(configured.shape) != stored.shape) add(text, "shape");
    if (configured.transform != stored.transform) add(text, "transform");
    if (configured.estimator != stored.estimator) add(text, "estimator");
    if (!same_start(configured.start, stored.start, configured.transform)) add(text, "start");
    ObjectParameters parameters = new_objects;
    // A name that there is not is refused before a session is made.
    static_cast<void>(set(parameters, configured.parameters));
    add_values(text, values(parameters), values(stored.parameters));
    return text;
}

std::string differences(const Settings& configured, const RequestedSettings& stored) {
    std::string text;
    if (stored.strategy && *stored.strategy != configured.strategy) add(text, "strategy");
    add_values(text, values(configured.strategy_parameters), stored.strategy_parameters);
    add_values(text, values(configured.tracker), stored.parameters);
    add_values(text, values(configured.new_objects), stored.parameters);
    return text;
}

}  // namespace pursuit::tracker
