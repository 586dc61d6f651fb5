// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "services/common/reader.hpp"
#include "services/common/request_id.hpp"
#include "services/common/writer.hpp"

namespace pursuit {

/// Calls a service and waits for its reply. Threads: call() from any, several at once.
template <class Request, class Reply>
class RequestClient {
 public:
    static Result<std::unique_ptr<RequestClient>> create(Participant& participant,
                                                         const char* request_topic,
                                                         const char* reply_topic,
                                                         std::string instance) {
        std::unique_ptr<RequestClient> self(new RequestClient(std::move(instance), request_topic));
        auto reader = Reader<Reply>::create(
            participant, reply_topic,
            [client = self.get()](Reply& reply, const auto&) { client->receive(reply); });
        if (!reader) return tl::unexpected(reader.error());
        self->reader_ = std::move(*reader);
        auto writer = Writer<Request>::create(participant, request_topic);
        if (!writer) return tl::unexpected(writer.error());
        self->writer_ = std::move(*writer);
        return self;
    }

    /// Waits until a service hears requests and we hear replies; false after `at_most`.
    bool wait_matched(std::chrono::milliseconds at_most) {
        std::unique_lock lock(mutex_);
        const auto until = Clock::now() + at_most;
        while (writer_->matched() == 0 || reader_->matched() == 0) {
            if (cancelled_ || Clock::now() >= until) return false;
            changed_.wait_for(lock, std::chrono::milliseconds(5));
        }
        return true;
    }

    /// How many readers hear the requests: services, and recorders of them.
    int heard_by() const { return writer_->matched(); }

    /// Sends `request` (its header is filled in) and waits for the reply.
    Result<Reply> call(Request& request, std::chrono::milliseconds at_most) {
        const auto until = Clock::now() + at_most;
        if (!wait_matched(at_most)) return nobody_answers(at_most);
        std::unique_lock lock(mutex_);
        const auto id = pursuit::request_id(writer_->guid(), ++sequence_);
        request.header().request_id(id);
        request.header().instance_name(instance_);
        const auto key = key_of(id);
        waiting_.emplace(key, std::nullopt);
        lock.unlock();
        if (!writer_->write(request)) {
            lock.lock();
            waiting_.erase(key);
            return fail("a request on " + topic_ + " could not be sent");
        }
        lock.lock();
        const auto is_over = [&] { return cancelled_ || waiting_.at(key).has_value(); };
        // What heard the request first may not have been the service: it is sent again under the
        // same id, which is applied once.
        while (!changed_.wait_until(lock, std::min(until, Clock::now() + again_after), is_over) &&
               Clock::now() < until) {
            lock.unlock();
            writer_->write(request);
            lock.lock();
        }
        const bool answered = waiting_.at(key).has_value();
        auto reply = std::move(waiting_.extract(key).mapped());
        if (!answered) {
            return fail("no reply on " + topic_ + " within " + std::to_string(at_most.count()) +
                        " ms");
        }
        return std::move(*reply);
    }

    /// As call(), by a process that comes, calls and goes: also recorders that hear of it later
    /// than the service does have the request. It is sent when nobody new has begun to hear for
    /// `quiet`; `on_unheard` is told when one of those has not acknowledged it `quiet` after the
    /// reply.
    Result<Reply> call_heard_by_all(Request& request, std::chrono::milliseconds at_most,
                                    std::chrono::milliseconds quiet,
                                    const std::function<void()>& on_unheard) {
        if (!wait_matched(at_most)) return nobody_answers(at_most);
        wait_for_listeners(quiet, at_most);
        auto reply = call(request, at_most);
        if (reply && !wait_acknowledged(quiet)) on_unheard();
        return reply;
    }

    /// Ends every call that waits, now and from now on: the process is to end.
    void cancel() {
        const std::scoped_lock lock(mutex_);
        cancelled_ = true;
        changed_.notify_all();
    }

 private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds again_after{500};

    RequestClient(std::string instance, std::string topic)
        : instance_(std::move(instance)), topic_(std::move(topic)) {}

    tl::unexpected<Error> nobody_answers(std::chrono::milliseconds at_most) const {
        return fail("no service answers on " + topic_ + " within " +
                    std::to_string(at_most.count()) + " ms");
    }

    /// Until nobody new has begun to hear requests for `quiet`, `at_most` in all.
    void wait_for_listeners(std::chrono::milliseconds quiet, std::chrono::milliseconds at_most) {
        std::unique_lock lock(mutex_);
        const auto until = Clock::now() + at_most;
        auto quiet_at = Clock::now() + quiet;
        int listeners = heard_by();
        while (!cancelled_ && Clock::now() < std::min(quiet_at, until)) {
            changed_.wait_for(lock, std::chrono::milliseconds(5));
            if (heard_by() == listeners) continue;
            listeners = heard_by();
            quiet_at = Clock::now() + quiet;
        }
    }

    /// Whether all that hear requests have what was sent.
    bool wait_acknowledged(std::chrono::milliseconds at_most) {
        const auto whole = std::chrono::duration_cast<std::chrono::seconds>(at_most);
        const std::chrono::nanoseconds rest = at_most - whole;
        return writer_->wait_acknowledged(
            {static_cast<std::int32_t>(whole.count()), static_cast<std::uint32_t>(rest.count())});
    }

    void receive(Reply& reply) {
        const std::scoped_lock lock(mutex_);
        const auto waiting = waiting_.find(key_of(reply.header().related_request_id()));
        if (waiting == waiting_.end()) return;  // another client's reply
        waiting->second = std::move(reply);
        changed_.notify_all();
    }

    const std::string instance_;
    const std::string topic_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::int64_t sequence_ = 0;
    bool cancelled_ = false;
    std::map<RequestKey, std::optional<Reply>> waiting_;
    std::unique_ptr<Writer<Request>> writer_;
    std::unique_ptr<Reader<Reply>> reader_;
};

}  // namespace pursuit
