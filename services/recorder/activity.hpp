// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "requests.h"
#include "services/common/result.hpp"
#include "status.h"

namespace pursuit::recorder {

/// What a recorder process does: it records, or it replays. Threads: all on the main thread, but
/// for `done` of new_file().
class Activity {
 public:
    using Done = std::function<void(v1::StatusCode, const std::string& message)>;

    virtual ~Activity() = default;

    virtual Result<void> start() = 0;
    virtual void tick() = 0;
    virtual bool finished() const = 0;
    virtual bool failed() const = 0;
    /// Ends every thread and closes every file.
    virtual void stop() = 0;

    /// What it does, or waits for, and its state.
    virtual std::string status_line() const = 0;
    virtual v1::ServiceState state() const = 0;
    /// Goes up with every change that a status should tell at once.
    virtual std::uint64_t changes() const = 0;
    /// All but instance and health; adds what its own participants count to that.
    virtual void fill(v1::RecorderStatus& status) const = 0;

    // Calls (idl/recorder_requests.idl). An error says why it is refused.
    virtual Result<void> pause(bool paused) = 0;
    virtual Result<void> set_rate(double rate) = 0;
    /// Calls `done` when the new file is there or cannot be, possibly on another thread.
    virtual void new_file(Done done) = 0;
};

}  // namespace pursuit::recorder
