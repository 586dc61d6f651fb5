// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "services/tracker/packet_intake.hpp"
#include "services/tracker/store_writer.hpp"
#include "services/tracker/tracker_session.hpp"

namespace pursuit::tracker {

/// The thread that runs a session: takes work from the queue, gives replies away, and hands the
/// state to the store after each change and figures to whoever asked.
///
/// Threads: the session belongs to this thread from start() to stop(); the rest is for any.
class CoreThread {
 public:
    using Reply = std::function<void(const v1::RequestId&, v1::TrackerReply)>;

    /// Figures are asked for at every tick, each 50 ms: about 5 s. A packet or a call takes well
    /// under one. Counted and not timed: a process that was halted as a whole is not stalled.
    static constexpr std::uint32_t most_unserved = 100;

    CoreThread(std::unique_ptr<TrackerSession> session, TrackerQueue& queue, StoreWriter& store,
               Reply reply);
    ~CoreThread() { stop(); }
    CoreThread(const CoreThread&) = delete;
    CoreThread& operator=(const CoreThread&) = delete;

    void start();
    /// Ends after the piece of work in hand; hands the last state to the store.
    void stop();

    /// Those of the last time they were asked for; asks for new ones.
    SessionFigures figures();
    /// Whether that was asked so many times in turn without the thread having got to it.
    bool stalled() const { return unserved_.load() >= most_unserved; }
    /// Hands the poses to the store, if event time has gone on since they were last.
    void store_poses();

 private:
    void run();
    void serve_wishes();
    void post_state();

    std::unique_ptr<TrackerSession> session_;
    TrackerQueue& queue_;
    StoreWriter& store_;
    Reply reply_;
    std::atomic<bool> figures_wanted_{false};
    std::atomic<std::uint32_t> unserved_{0};
    std::atomic<bool> store_wanted_{false};
    std::uint64_t stored_revision_ = 0;
    StoredMoment stored_moment_;
    std::mutex mutex_;
    SessionFigures figures_;
    std::thread thread_;
};

}  // namespace pursuit::tracker
