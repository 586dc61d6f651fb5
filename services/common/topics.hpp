// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "eventsPubSubTypes.h"
#include "modelsPubSubTypes.h"
#include "posesPubSubTypes.h"
#include "recorder_requestsPubSubTypes.h"
#include "sensor_requestsPubSubTypes.h"
#include "statusPubSubTypes.h"
#include "tracker_requestsPubSubTypes.h"

namespace pursuit {

/// The names of every topic, as in idl/README.md.
namespace topic {
inline constexpr auto events = "pursuit/events";
inline constexpr auto exposures = "pursuit/exposures";
inline constexpr auto poses = "pursuit/poses";
inline constexpr auto pose_tracks = "pursuit/pose_tracks";
inline constexpr auto models = "pursuit/models";
inline constexpr auto tracker_settings = "pursuit/tracker_settings";
inline constexpr auto sensor_status = "pursuit/sensor_status";
inline constexpr auto tracker_status = "pursuit/tracker_status";
inline constexpr auto recorder_status = "pursuit/recorder_status";
inline constexpr auto sensor_request = "pursuit/sensor/request";
inline constexpr auto sensor_reply = "pursuit/sensor/reply";
inline constexpr auto tracker_request = "pursuit/tracker/request";
inline constexpr auto tracker_reply = "pursuit/tracker/reply";
inline constexpr auto recorder_request = "pursuit/recorder/request";
inline constexpr auto recorder_reply = "pursuit/recorder/reply";
}  // namespace topic

/// The generated type support of a message, and whether a received one keeps the bounds that its
/// IDL states (generated readers do not check the bounds of sequences).
template <class T>
struct Wire;

/// Stated bounds, from idl/.
inline constexpr std::size_t max_packet_words = 8000;
inline constexpr std::size_t max_model_points = 4096;
inline constexpr std::size_t max_named_values = 32;

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): ten specialisations of three lines each.
#define PURSUIT_WIRE(Type, bounds)                                                   \
    template <>                                                                      \
    struct Wire<v1::Type> {                                                          \
        using Support = v1::Type##PubSubType;                                        \
        static bool in_bounds([[maybe_unused]] const v1::Type& m) { return bounds; } \
    };

PURSUIT_WIRE(EventPacket, m.words().size() <= max_packet_words)
PURSUIT_WIRE(ObjectPose, m.state() <= v1::TRACK_LOST && m.transform() <= v1::TRANSFORM_FULL_AFFINE)
PURSUIT_WIRE(PoseTrack, m.updates().size() <= 1000)
PURSUIT_WIRE(RegisteredModel, m.points().size() <= max_model_points &&
                                  m.edges().size() <= max_model_points &&
                                  m.parameters().size() <= max_named_values)
PURSUIT_WIRE(TrackerSettings, m.strategy_parameters().size() <= max_named_values &&
                                  m.parameters().size() <= max_named_values)
PURSUIT_WIRE(SensorStatus, m.dropped_by().size() <= 32)
PURSUIT_WIRE(TrackerStatus, m.dropped_by().size() <= 32)
PURSUIT_WIRE(RecorderStatus, m.dropped_by().size() <= 32 && m.topics().size() <= 64)
// What a request holds is checked by the service, which can answer with the field and its bound.
PURSUIT_WIRE(TrackerRequest, true)
PURSUIT_WIRE(TrackerReply, true)
PURSUIT_WIRE(SensorRequest, true)
PURSUIT_WIRE(SensorReply, true)
PURSUIT_WIRE(RecorderRequest, true)
PURSUIT_WIRE(RecorderReply, true)
#undef PURSUIT_WIRE

}  // namespace pursuit
