// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/commands/service_calls.hpp"

#include <chrono>

#include "services/common/request_client.hpp"
#include "services/common/topics.hpp"

namespace pursuit::ctl {
namespace {

constexpr std::chrono::milliseconds listeners_quiet{200};
constexpr std::chrono::milliseconds listeners_at_most{600};

template <class Request, class Reply>
Result<Reply> call(const DdsOptions& options, const char* request_topic, const char* reply_topic,
                   Request& request) {
    auto participant = join(options);
    if (!participant) return tl::unexpected(participant.error());
    auto client = RequestClient<Request, Reply>::create(**participant, request_topic, reply_topic,
                                                        options.name);
    if (!client) return tl::unexpected(client.error());
    if ((*client)->wait_matched(options.timeout())) {
        // A recorder that hears of this process later than the service would miss the request.
        (*client)->wait_for_listeners(listeners_quiet, listeners_at_most);
    }
    auto reply = (*client)->call(request, options.timeout());
    (*client)->wait_acknowledged(listeners_at_most);
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
