// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config.pb.h"
#include "services/common/result.hpp"
#include "services/tracker/core/tracker.hpp"

namespace pursuit::tracker {

/// A tracker with the constants that the configuration states, and no object. Ids below
/// `next_object_id` were used before. `only_checks`: to try models on. An error is one of a field.
Result<Tracker> configured_tracker(const disk::TrackerConfig& config, std::uint32_t next_object_id,
                                   bool only_checks = false);

/// The registration of PATH[@x,y,theta[,scale]] (model_file.hpp). Without "@…" an object begins
/// where its file says that the model was made, or is searched for. A start with a scale is tracked
/// as a similarity, else as an isometry. An error names file and line.
Result<Registration> configured_model(const std::string& argument, EstimatorKind estimator);

/// The models that the configuration names, tracked by the preset's estimator. An error is one of a
/// field; two models of one name are one, whatever their starts: a name is one object.
Result<std::vector<Registration>> configured_models(const disk::TrackerConfig& config);

}  // namespace pursuit::tracker
