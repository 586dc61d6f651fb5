// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracker_requests.h"

namespace pursuit {

/// Whether a call changes the tracker's state: it takes effect at a time of the events, and belongs
/// to what a replay does again. The others only ask.
inline bool changes_tracker(v1::TrackerCallKind kind) {
    switch (kind) {
        case v1::TRACKER_REGISTER_MODEL:
        case v1::TRACKER_UPDATE_MODEL:
        case v1::TRACKER_REMOVE_MODEL:
        case v1::TRACKER_SET_POSE:
        case v1::TRACKER_SET_OCCLUSION_STRATEGY:
        case v1::TRACKER_SET_PARAMETERS:
            return true;
        case v1::TRACKER_LIST_MODELS:
        case v1::TRACKER_GET_MODEL:
        case v1::TRACKER_GET_OCCLUSION_STRATEGY:
        case v1::TRACKER_GET_STATUS:
            return false;
    }
    return false;
}

}  // namespace pursuit
