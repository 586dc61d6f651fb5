// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/commands/service_calls.hpp"

#include <chrono>
#include <cstdio>

#include "services/common/request_client.hpp"
#include "services/common/topics.hpp"
#include "services/common/tracker_call_kinds.hpp"

namespace pursuit::ctl {
namespace {

// Who missed the first word of this process hears the next one, 0.25 s later (Participant).
constexpr std::chrono::milliseconds listeners_quiet{350};

/// What only asks need not be recorded, nor what a replay does not do again.
bool is_to_be_recorded(const v1::TrackerRequest& request) {
    return changes_tracker(request.call()._d());
}
bool is_to_be_recorded(const v1::SensorRequest&) { return false; }
bool is_to_be_recorded(const v1::RecorderRequest&) { return false; }

template <class Request, class Reply>
Result<Reply> call(const DdsOptions& options, const char* request_topic, const char* reply_topic,
                   Request& request) {
    auto participant = join(options);
    if (!participant) return tl::unexpected(participant.error());
    auto client = RequestClient<Request, Reply>::create(**participant, request_topic, reply_topic,
                                                        options.name);
    if (!client) return tl::unexpected(client.error());
    const auto tell_unheard = [&] {
        std::fprintf(stderr, "pursuitctl: a recorder may have missed this request on %s\n",
                     request_topic);
    };
    auto reply = is_to_be_recorded(request)
                     ? (*client)->call_heard_by_all(request, options.timeout(), listeners_quiet,
                                                    tell_unheard)
                     : (*client)->call(request, options.timeout());
    if (!reply) return fail(reply.error().message + " " + where(options));
    if (reply->outcome().code() != v1::STATUS_OK) {
        return fail("refused: " + reply->outcome().message().to_string());
    }
    return reply;
}

}  // namespace

Result<v1::TrackerReply> call_tracker(const DdsOptions& options, v1::TrackerRequest& request) {
    return call<v1::TrackerRequest, v1::TrackerReply>(options, topic::tracker_request,
                                                      topic::tracker_reply, request);
}

Result<v1::SensorReply> call_sensor(const DdsOptions& options, v1::SensorRequest& request) {
    return call<v1::SensorRequest, v1::SensorReply>(options, topic::sensor_request,
                                                    topic::sensor_reply, request);
}

Result<v1::RecorderReply> call_recorder(const DdsOptions& options, v1::RecorderRequest& request) {
    return call<v1::RecorderRequest, v1::RecorderReply>(options, topic::recorder_request,
                                                        topic::recorder_reply, request);
}

}  // namespace pursuit::ctl
