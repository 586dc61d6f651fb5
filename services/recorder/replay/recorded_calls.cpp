// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/recorded_calls.hpp"

#include <utility>

#include "services/common/tracker_call_kinds.hpp"
#include "services/recorder/replay/planned_call.hpp"

namespace pursuit::recorder {
namespace {

bool changed_something(const v1::TrackerReply& reply) {
    if (reply.outcome().code() != v1::STATUS_OK) return false;
    return reply.result()._d() != v1::TRACKER_REGISTER_MODEL ||
           !reply.result().register_model().already_registered();
}

}  // namespace

std::optional<RecordedCall> RecordedCalls::take(v1::TrackerRequest request) {
    if (!changes_tracker(request.call()._d())) return std::nullopt;
    auto* found = exchange(request.header().request_id());
    if (found == nullptr || found->request || found->given) return std::nullopt;
    found->request = std::move(request);
    return give(*found);
}

std::optional<RecordedCall> RecordedCalls::take(v1::TrackerReply reply, std::size_t stream) {
    if (!changes_tracker(reply.result()._d())) return std::nullopt;
    auto* found = exchange(reply.header().related_request_id());
    if (found == nullptr || found->reply || found->given) return std::nullopt;
    found->stream = stream;
    found->order = ++replies_;
    found->reply = std::move(reply);
    return give(*found);
}

RecordedCalls::Exchange* RecordedCalls::exchange(const v1::RequestId& id) {
    const auto key = key_of(id);
    const auto known = exchanges_.find(key);
    if (known != exchanges_.end()) return &known->second;
    if (exchanges_.size() >= most_planned_calls) {
        too_many_ = true;
        return nullptr;
    }
    return &exchanges_[key];
}

std::optional<RecordedCall> RecordedCalls::give(Exchange& exchange) {
    if (!exchange.request || !exchange.reply) return std::nullopt;
    RecordedCall call{std::move(*exchange.request), std::move(*exchange.reply), exchange.stream,
                      exchange.order};
    exchange.request.reset();
    exchange.reply.reset();
    exchange.given = true;
    return call;
}

std::uint64_t RecordedCalls::unanswered() const {
    std::uint64_t count = 0;
    for (const auto& [key, exchange] : exchanges_) {
        if (exchange.request && !exchange.reply) ++count;
    }
    return count;
}

std::uint64_t RecordedCalls::unasked() const {
    std::uint64_t count = 0;
    for (const auto& [key, exchange] : exchanges_) {
        if (exchange.reply && !exchange.request && changed_something(*exchange.reply)) ++count;
    }
    return count;
}

}  // namespace pursuit::recorder
