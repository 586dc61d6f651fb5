// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core_thread.hpp"

#include <pthread.h>

#include <utility>
#include <variant>

namespace pursuit::tracker {

CoreThread::CoreThread(std::unique_ptr<TrackerSession> session, TrackerQueue& queue,
                       StoreWriter& store, Reply reply)
    : session_(std::move(session)), queue_(queue), store_(store), reply_(std::move(reply)) {}

void CoreThread::start() {
    figures_ = session_->figures();
    post_state();
    thread_ = std::thread([this] { run(); });
}

void CoreThread::stop() {
    queue_.close();
    if (!thread_.joinable()) return;
    thread_.join();
    figures_ = session_->figures();
    post_state();
}

SessionFigures CoreThread::figures() {
    unserved_.fetch_add(1);
    figures_wanted_ = true;
    queue_.wake();
    const std::scoped_lock lock(mutex_);
    return figures_;
}

void CoreThread::store_poses() {
    store_wanted_ = true;
    queue_.wake();
}

void CoreThread::run() {
    ::pthread_setname_np(::pthread_self(), "core");  // as top -H and debuggers show it
    for (;;) {
        auto work = queue_.pop();
        if (!work) {
            if (queue_.closed()) return;
            serve_wishes();
            continue;
        }
        if (auto* packet = std::get_if<v1::EventPacket>(&*work)) {
            session_->take(*packet);
        } else {
            auto& request = std::get<v1::TrackerRequest>(*work);
            const v1::RequestId id = request.header().request_id();
            reply_(id, session_->answer(request));
        }
        if (session_->revision() != stored_revision_) post_state();
        // Not only when there is nothing else to do: who asks wants to know how far behind it is.
        serve_wishes();
    }
}

void CoreThread::serve_wishes() {
    if (figures_wanted_.exchange(false)) {
        unserved_ = 0;
        SessionFigures now = session_->figures();
        const std::scoped_lock lock(mutex_);
        figures_ = std::move(now);
    }
    if (!store_wanted_.exchange(false) || !store_.keeps()) return;
    if (session_->stored_moment() != stored_moment_) post_state();
}

void CoreThread::post_state() {
    stored_revision_ = session_->revision();
    if (!store_.keeps()) return;
    StoredState state = session_->stored_state();
    stored_moment_ = state.moment;
    store_.post(std::move(state));
}

}  // namespace pursuit::tracker
