// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "config.pb.h"
#include "services/common/clock.hpp"
#include "services/common/health.hpp"
#include "services/common/request_server.hpp"
#include "services/common/service_main.hpp"
#include "services/common/writer.hpp"
#include "services/tracker/core_thread.hpp"
#include "services/tracker/store_lock.hpp"
#include "services/tracker/tracker_status.hpp"

namespace pursuit::tracker {

/// The DDS shell of the tracker.
///
///   reader of events ──┐                                     ┌─► poses, pose tracks, models
///                      ├─► bounded queue ─► core thread ─────┼─► replies
///   request server ────┘   (arrival order)  (a session)      └─► store thread ─► file
///   main thread: status at 1 Hz and on change, sensor silence, when to store
///
/// Threads: as Service; the listeners only move what came to the queue.
class TrackerService final : public Service {
 public:
    /// Reads the models and tries the constants; an error is one of the configuration.
    static Result<std::unique_ptr<Service>> make(const disk::TrackerConfig& config);

    Result<void> start() override;
    void tick() override;
    bool finished() const override { return false; }
    bool failed() const override { return false; }
    std::string status_line() const override { return described_; }
    std::string stalled() const override;
    void stop() override;

 private:
    using Server = RequestServer<v1::TrackerRequest, v1::TrackerReply>;

    TrackerService(const disk::TrackerConfig& config, std::vector<Registration> models);

    Result<void> open_writers();
    Result<void> open_readers();
    void receive(v1::TrackerRequest& request, Server& server);
    void forget_poses(std::uint32_t object_id);
    v1::TrackerStatus status(const SessionFigures& figures);
    void publish_status();
    void count_rest();
    void publish_last_status();

    const disk::TrackerConfig config_;
    const std::vector<Registration> models_;
    const ServiceIdentity identity_;
    SystemClock clock_;
    Health health_;
    IntakeCounters intake_;
    TrackerQueue queue_;
    // Gone in the reverse order: readers and server before what they call.
    std::unique_ptr<Participant> participant_;
    std::unique_ptr<Writer<v1::ObjectPose>> poses_;
    std::unique_ptr<Writer<v1::PoseTrack>> tracks_;
    std::unique_ptr<Writer<v1::RegisteredModel>> model_writer_;
    std::unique_ptr<Writer<v1::TrackerSettings>> settings_;
    std::unique_ptr<Writer<v1::TrackerStatus>> status_;
    StoreLock store_lock_;
    std::unique_ptr<StoreWriter> store_;
    std::unique_ptr<CoreThread> core_;
    std::unique_ptr<Server> requests_;
    std::unique_ptr<Reader<v1::EventPacket>> events_;
    std::string described_;
    std::int64_t last_status_ns_ = 0;
    std::int64_t last_store_ns_ = 0;
    std::uint64_t last_errors_ = 0;
    v1::ServiceState last_state_ = v1::SERVICE_STARTING;
    std::uint32_t last_objects_ = 0;
    bool was_silent_ = false;
};

}  // namespace pursuit::tracker
