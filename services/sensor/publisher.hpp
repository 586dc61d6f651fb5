// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "services/sensor/stream_sender.hpp"

namespace pursuit::sensor {

/// Sends the streams of one source, on threads of its own: start(), then stop() once.
/// Threads: start() and stop() on one; the rest from any.
class Publisher {
 public:
    enum class State { waiting, running, finished, failed };

    virtual ~Publisher() = default;
    virtual void start() = 0;
    virtual void stop() = 0;

    State state() const { return state_.load(); }
    const PublisherCounts& counts() const { return counts_; }

    /// For people: what is waited for while waiting, or what is to be said while running.
    virtual std::string remark() const = 0;

    /// Further causes of lost events, by name.
    virtual std::vector<std::pair<std::string, std::uint64_t>> losses() const { return {}; }

    /// How much faster than CLOCK_REALTIME the sensor's clock runs; 0 where it is this host's own.
    virtual double drift_ppm() const { return 0; }

 protected:
    PublisherCounts counts_;
    std::atomic<State> state_{State::waiting};
};

}  // namespace pursuit::sensor
