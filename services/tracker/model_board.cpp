// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/model_board.hpp"

#include "services/tracker/tracker_wire.hpp"

namespace pursuit::tracker {
namespace {

bool same(const RegisteredObject& a, const RegisteredObject& b) {
    return a.effective_time_us == b.effective_time_us && a.transform == b.transform &&
           a.estimator == b.estimator && a.start == b.start && a.parameters == b.parameters &&
           a.shape == b.shape;
}

bool same(const Settings& a, const Settings& b) {
    return a.effective_time_us == b.effective_time_us && a.strategy == b.strategy &&
           a.strategy_parameters == b.strategy_parameters && a.tracker == b.tracker &&
           a.new_objects == b.new_objects;
}

}  // namespace

std::vector<std::uint32_t> ModelBoard::refresh(const Tracker& tracker) {
    const auto settings = tracker.settings();
    if (!settings_ || !same(*settings_, settings)) {
        auto sample = tracker_settings(identity_.instance, identity_.sensor_id, settings);
        if (!write_settings_(sample)) ++failures_;
        settings_ = settings;
    }
    std::map<std::uint32_t, RegisteredObject> now;
    for (auto& object : tracker.objects()) now.emplace(object.object_id, object);
    std::vector<std::uint32_t> gone;
    for (const auto& [object_id, object] : published_) {
        if (now.contains(object_id)) continue;
        auto sample = registered_model(identity_.sensor_id, object);
        sample.registered(false);
        sample.effective_time_us(tracker.effective_time_us());
        if (!write_model_(sample)) ++failures_;
        gone.push_back(object_id);
        removed_.push_back(object_id);
    }
    for (; removed_.size() > removals_kept; removed_.pop_front()) {
        v1::RegisteredModel key;
        key.sensor_id(identity_.sensor_id);
        key.object_id(removed_.front());
        if (!forget_model_(key)) ++failures_;
    }
    for (const auto& [object_id, object] : now) {
        const auto known = published_.find(object_id);
        if (known != published_.end() && same(known->second, object)) continue;
        auto sample = registered_model(identity_.sensor_id, object);
        if (!write_model_(sample)) ++failures_;
    }
    published_ = std::move(now);
    return gone;
}

}  // namespace pursuit::tracker
