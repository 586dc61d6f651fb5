// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "services/common/clock.hpp"
#include "services/common/newcomer_repeats.hpp"
#include "services/common/reader.hpp"
#include "services/common/request_id.hpp"
#include "services/common/writer.hpp"

namespace pursuit {

/// Serves one kind of request: hands each new request to a handler, which answers by answer(),
/// at once or later, from any thread.
///
///   new id ──► pending ──answer()──► answered (the last 256 replies are kept)
///   known id: pending → nothing more happens; answered → the same reply is sent again
///
/// So a request that is sent twice is applied once. Requests for another instance are not heard.
///
/// A client may know of the server before the server knows of the client's reader: a reply sent in
/// between would reach nobody. What was answered is sent again to a participant whose reader is
/// matched later than that; and what it is sent then may pass it by (NewcomerRepeats).
/// Threads: the handler runs on the receiving thread and must not block; answer() and tick() from
/// any.
template <class Request, class Reply>
class RequestServer {
 public:
    using Handler = std::function<void(Request&, RequestServer&)>;
    static constexpr std::size_t kept_replies = 256;
    static constexpr std::size_t most_pending = 1024;

    static Result<std::unique_ptr<RequestServer>> create(Participant& participant,
                                                         const char* request_topic,
                                                         const char* reply_topic,
                                                         std::string instance, Handler handler) {
        std::unique_ptr<RequestServer> self(
            new RequestServer(std::move(instance), std::move(handler)));
        auto writer = Writer<Reply>::create(participant, reply_topic);
        if (!writer) return tl::unexpected(writer.error());
        self->writer_ = std::move(*writer);
        self->writer_->on_matched(
            [server = self.get()](const auto& prefix) { server->greet(prefix); });
        auto reader = Reader<Request>::create(
            participant, request_topic,
            [server = self.get()](Request& request, const auto&) { server->receive(request); });
        if (!reader) return tl::unexpected(reader.error());
        self->reader_ = std::move(*reader);
        return self;
    }

    /// Sends `reply` to the writer of `id`; fills its header but for the exception.
    void answer(const v1::RequestId& id, Reply reply) {
        reply.header().related_request_id(id);
        reply.header().instance_name(instance_);
        const std::scoped_lock lock(mutex_);
        const auto key = key_of(id);
        if (replies_.size() >= kept_replies && !order_.empty()) {
            replies_.erase(order_.front());
            order_.pop_front();
        }
        pending_.erase(key);
        if (replies_.emplace(key, reply).second) order_.push_back(key);
        send(reply);
    }

    /// Sends the replies again that are due for it; to be called at least every 100 ms.
    void tick() {
        const std::scoped_lock lock(mutex_);
        for (const auto& key : repeats_.due(clock_.steady_ns())) {
            if (const auto known = replies_.find(key); known != replies_.end()) {
                write(known->second);
            }
        }
    }

    /// Requests not taken because too many were pending: their senders hear nothing.
    std::uint64_t overflows() const { return overflows_.load(); }
    /// Replies that the middleware did not take.
    std::uint64_t failures() const { return writer_->failures(); }

 private:
    RequestServer(std::string instance, Handler handler)
        : instance_(std::move(instance)), handler_(std::move(handler)) {}

    void receive(Request& request) {
        const std::string wanted = request.header().instance_name().to_string();
        if (!wanted.empty() && wanted != instance_) return;
        const auto key = key_of(request.header().request_id());
        {
            const std::scoped_lock lock(mutex_);
            if (const auto known = replies_.find(key); known != replies_.end()) {
                send(known->second);
                return;
            }
            if (pending_.contains(key)) return;
            if (pending_.size() >= most_pending) {
                overflows_.fetch_add(1);
                return;
            }
            pending_.emplace(key, true);
        }
        handler_(request, *this);
    }

    /// A participant's reader has come: what it was answered before, it has not heard.
    void greet(const eprosima::fastrtps::rtps::GuidPrefix_t& prefix) {
        const std::scoped_lock lock(mutex_);
        ParticipantKey participant{};
        std::copy_n(prefix.value, participant.size(), participant.begin());
        repeats_.matched(participant, clock_.steady_ns());
        for (auto& [key, reply] : replies_) {
            if (participant_of(key) == participant) send(reply);
        }
    }

    void send(Reply& reply) {
        write(reply);
        repeats_.sent(key_of(reply.header().related_request_id()), clock_.steady_ns());
    }

    void write(Reply& reply) {
        // Fast DDS clients find their reply by this; others by the header.
        eprosima::fastrtps::rtps::WriteParams params;
        params.related_sample_identity(sample_identity(reply.header().related_request_id()));
        writer_->write(reply, params);
    }

    const std::string instance_;
    const Handler handler_;
    SystemClock clock_;
    std::mutex mutex_;
    NewcomerRepeats repeats_;
    std::map<RequestKey, Reply> replies_;
    std::deque<RequestKey> order_;
    std::map<RequestKey, bool> pending_;
    std::atomic<std::uint64_t> overflows_{0};
    std::unique_ptr<Writer<Reply>> writer_;
    std::unique_ptr<Reader<Request>> reader_;  // last made, first gone: no call after the rest
};

}  // namespace pursuit
