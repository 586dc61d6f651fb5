// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "requests.h"
#include "services/tracker/core/tracker.hpp"
#include "tracker_requests.h"

namespace pursuit::tracker {

/// Who serves: what results carry of it.
struct ServiceIdentity {
    std::string instance;
    std::uint32_t sensor_id = 1;
};

/// What a call came to.
struct CallAnswer {
    v1::RemoteException remote_exception = v1::REMOTE_OK;
    v1::Outcome outcome;
    v1::TrackerResult result;
    bool changed = false;  ///< Whether anything of the tracker is different now.

    [[nodiscard]] bool ok() const { return outcome.code() == v1::STATUS_OK; }
};

/// A refusal, with the message cut to what the wire holds.
CallAnswer refusal(v1::StatusCode code, const std::string& message,
                   v1::RemoteException exception = v1::REMOTE_OK);

/// Does one call now. A refusal changes nothing and names the field and its bound; whatever the
/// network sent is answered. Not for TRACKER_GET_STATUS, which is not the tracker's to answer.
CallAnswer dispatch(Tracker& tracker, const v1::TrackerCall& call, const ServiceIdentity& identity);

/// A tracker of the same options, objects and settings that follows nothing: to try calls on.
/// Costs about a copy of the models.
CallResult<Tracker> trial_of(const Tracker& tracker);

}  // namespace pursuit::tracker
