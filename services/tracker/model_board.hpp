// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "models.h"
#include "services/tracker/call_dispatch.hpp"
#include "services/tracker/core/tracker.hpp"

namespace pursuit::tracker {

/// Keeps the latched topics pursuit/models and pursuit/tracker_settings at what the tracker holds:
/// publishes what differs from what was published last. One thread.
class ModelBoard {
 public:
    using WriteModel = std::function<bool(v1::RegisteredModel&)>;
    using WriteSettings = std::function<bool(v1::TrackerSettings&)>;

    /// `forget_model`: of the object whose key is in the model nothing more is written; the
    /// middleware, which has room for so many objects, may forget it.
    ModelBoard(ServiceIdentity identity, WriteModel write_model, WriteSettings write_settings,
               WriteModel forget_model)
        : identity_(std::move(identity)),
          write_model_(std::move(write_model)),
          write_settings_(std::move(write_settings)),
          forget_model_(std::move(forget_model)) {}

    /// So many that were removed last are not forgotten yet: a reader that missed a removal gets it
    /// again, and one that comes late is told of so many at most.
    static constexpr std::size_t removals_kept = 16;

    /// Gives the ids of the objects that are gone since the last call.
    std::vector<std::uint32_t> refresh(const Tracker& tracker);

    [[nodiscard]] std::uint64_t failures() const { return failures_; }

 private:
    ServiceIdentity identity_;
    WriteModel write_model_;
    WriteSettings write_settings_;
    WriteModel forget_model_;
    std::deque<std::uint32_t> removed_;
    std::map<std::uint32_t, RegisteredObject> published_;
    std::optional<Settings> settings_;
    std::uint64_t failures_ = 0;
};

}  // namespace pursuit::tracker
