// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "models.h"
#include "services/recorder/replay/recorded_calls.hpp"

namespace pursuit::recorder {

/// What held before a recording began: the models and settings that its trackers told of first, and
/// that no recorded call brought about. Threads: one. At most most_planned_calls of either.
class StateBefore {
 public:
    /// As told of by a tracker, in this stream of its sensor. Only the first of its kind counts.
    void take(const v1::RegisteredModel& model, std::size_t stream);
    void take(const v1::TrackerSettings& settings, std::size_t stream);

    /// A recorded call that succeeded: what it brought about did not hold before.
    void take(const RecordedCall& call);

    /// A call that brings some of it about.
    struct Call {
        v1::TrackerRequest request;
        std::uint32_t sensor_id = 0;
        std::string instance;  ///< Of the tracker; empty where not known.
        std::size_t stream = 0;
    };

    /// Which sensor a tracker is for, by its instance.
    using SensorOf = std::function<std::uint32_t(const std::string& instance)>;

    /// Of each sensor settings first, because models take gains from them.
    std::vector<Call> calls(const SensorOf& sensor_of) const;

 private:
    /// What a recorded call set for a tracker as a whole.
    struct SettingsCall {
        std::optional<v1::OcclusionStrategy> strategy;  ///< With its parameters; else the others.
        std::vector<v1::NamedValue> parameters;
    };

    static bool shows(const v1::TrackerSettings& settings, const SettingsCall& call);
    bool was_called_for(const v1::TrackerSettings& settings) const;

    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<v1::RegisteredModel, std::size_t>>
        first_models_;  ///< By sensor and object; with the stream.
    std::map<std::string, std::pair<v1::TrackerSettings, std::size_t>> first_settings_;
    /// Objects that a recorded call registered, by the tracker's instance: each counts its own ids.
    std::set<std::pair<std::string, std::uint32_t>> registered_;
    /// By the tracker's instance and the time from which they hold.
    std::multimap<std::pair<std::string, std::int64_t>, SettingsCall> settings_calls_;
};

}  // namespace pursuit::recorder
