// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/tracker_calls.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace pursuit::recorder {

Result<std::unique_ptr<TrackerCalls>> TrackerCalls::create(Participant& participant,
                                                           const ReplayPlan& plan) {
    std::unique_ptr<TrackerCalls> self(new TrackerCalls);
    for (const auto& [sensor_id, calls] : plan.calls) {
        for (const auto& call : calls) {
            const auto instance = call.request.header().instance_name().to_string();
            if (self->clients_.contains(instance)) continue;
            auto client =
                Client::create(participant, topic::tracker_request, topic::tracker_reply, instance);
            if (!client) return tl::unexpected(client.error());
            self->clients_.emplace(instance, std::move(*client));
        }
    }
    if (self->clients_.empty()) {
        auto client = Client::create(participant, topic::tracker_request, topic::tracker_reply, "");
        if (!client) return tl::unexpected(client.error());
        self->clients_.emplace("", std::move(*client));
    }
    return self;
}

bool TrackerCalls::wait_matched(std::chrono::milliseconds at_most) {
    return std::all_of(clients_.begin(), clients_.end(),
                       [&](auto& each) { return each.second->wait_matched(at_most); });
}

Result<void> TrackerCalls::make(const PlannedCall& call, bool begins_stream) {
    auto& client = *clients_.at(call.request.header().instance_name().to_string());
    auto request = call.request;
    auto reply = client.call(request, patience);
    const auto refused_as = [&](v1::StatusCode code) {
        return reply && reply->outcome().code() == code;
    };
    if (refused_as(v1::STATUS_TOO_LATE) && begins_stream) {
        // It is in another stream still, whose time is further: before the first packet is now.
        request.apply_at_us(0);
        reply = client.call(request, patience);
    }
    if (refused_as(v1::STATUS_ALREADY_EXISTS) &&
        request.call()._d() == v1::TRACKER_REGISTER_MODEL &&
        request.call().register_model().object_id() != 0) {
        // The tracker is not fresh: the id of the recording was in use before.
        spdlog::warn("{}: {}; another id is taken", call.name,
                     reply->outcome().message().to_string());
        request.call().register_model().object_id(0);
        reply = client.call(request, patience);
    }
    if (!reply) return fail(call.name + ": " + reply.error().message);
    if (reply->header().remote_exception() != v1::REMOTE_OK ||
        reply->outcome().code() != v1::STATUS_OK) {
        return fail(call.name + ": refused: " + reply->outcome().message().to_string());
    }
    if (reply->result()._d() == v1::TRACKER_REGISTER_MODEL &&
        reply->result().register_model().already_registered()) {
        spdlog::warn(
            "{}: was registered before and goes on from where it is; the poses of a "
            "tracker that is not fresh differ from the recorded ones",
            call.name);
        return {};
    }
    spdlog::info("{}: done", call.name);
    return {};
}

Result<std::size_t> TrackerCalls::room() {
    std::size_t least = room_unasked;
    if (!wait_matched(std::chrono::milliseconds(0))) return least;
    for (auto& [instance, client] : clients_) {
        v1::TrackerRequest request;
        request.call().get_status({});
        const auto reply = client->call(request, patience);
        if (!reply) return tl::unexpected(reply.error());
        if (reply->result()._d() != v1::TRACKER_GET_STATUS) {
            return fail("the tracker gave no status");
        }
        const auto& status = reply->result().get_status();
        const auto taken = std::min(status.queue_packets(), status.queue_capacity());
        // Half, because what is on its way will be there as well.
        least = std::min<std::size_t>(least, (status.queue_capacity() - taken) / 2);
    }
    return least;
}

void TrackerCalls::cancel() {
    for (auto& [instance, client] : clients_) client->cancel();
}

}  // namespace pursuit::recorder
