// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/planned_call.hpp"

namespace pursuit::recorder {

std::string name_of(const v1::TrackerRequest& request) {
    const auto& call = request.call();
    const auto named = [&]() -> std::string {
        switch (call._d()) {
            case v1::TRACKER_REGISTER_MODEL:
                return "register model " + call.register_model().name().to_string();
            case v1::TRACKER_UPDATE_MODEL:
                return "update model " + call.update_model().name().to_string();
            case v1::TRACKER_REMOVE_MODEL:
                return "remove model " + call.remove_model().name().to_string();
            case v1::TRACKER_SET_POSE:
                return "set pose of " + call.set_pose().name().to_string();
            case v1::TRACKER_SET_OCCLUSION_STRATEGY:
                return "set occlusion strategy";
            case v1::TRACKER_SET_PARAMETERS:
                return "set parameters " + call.set_parameters().name().to_string();
            default:
                return "call";
        }
    };
    return named() + " at " + std::to_string(request.apply_at_us()) + " us";
}

}  // namespace pursuit::recorder
