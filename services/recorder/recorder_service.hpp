// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <memory>
#include <mutex>

#include "config.pb.h"
#include "services/common/health.hpp"
#include "services/common/request_server.hpp"
#include "services/common/service_main.hpp"
#include "services/common/writer.hpp"
#include "services/recorder/activity.hpp"

namespace pursuit::recorder {

/// The recorder on DDS: serves its requests, publishes its status, and runs what it does.
/// Threads: requests wait in a queue for tick(), so that everything but the activity's own threads
/// is on the main one.
class RecorderService final : public Service {
 public:
    /// Refuses a configuration that asks for neither or both of recording and replaying, for a
    /// folder as output, for a replay of what is no recording, or for a topic that there is not.
    /// `configuration` must outlive it.
    static Result<std::unique_ptr<Service>> make(const disk::RecorderConfig& configuration);

    explicit RecorderService(const disk::RecorderConfig& configuration);
    ~RecorderService() override;

    Result<void> start() override;
    void tick() override;
    bool finished() const override { return activity_->finished(); }
    bool failed() const override { return activity_->failed(); }
    std::string status_line() const override { return activity_->status_line(); }
    void stop() override;

 private:
    using Server = RequestServer<v1::RecorderRequest, v1::RecorderReply>;

    void serve(const v1::RecorderRequest& request);
    void answer(const v1::RecorderRequest& request, v1::StatusCode code,
                const std::string& message);
    v1::RecorderStatus status();
    void publish_status();

    const disk::RecorderConfig& configuration_;
    const std::string instance_;
    Health health_;
    std::unique_ptr<Activity> activity_;
    std::unique_ptr<Participant> participant_;
    std::unique_ptr<Writer<v1::RecorderStatus>> status_writer_;
    std::mutex mutex_;
    std::deque<v1::RecorderRequest> requests_;  ///< Bounded by Server::most_pending.
    std::unique_ptr<Server> server_;
    std::chrono::steady_clock::time_point status_due_{};
    std::uint64_t told_changes_ = 0;
    std::uint64_t told_errors_ = 0;
};

}  // namespace pursuit::recorder
