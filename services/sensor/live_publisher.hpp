// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "services/sensor/live/live_input.hpp"
#include "services/sensor/publisher.hpp"

namespace pursuit::sensor {

/// Sends what a live source hears, at once: one thread hears, another sends, and between them lies
/// the bounded queue.
///
///   waiting (for subscribers, for the source) ⇄ running ⇄ paused ──► finished | failed
///
/// While it is paused the queue fills; then the oldest events are dropped, and counted. A packet
/// that is not full is sent when nothing has come for 5 ms. No reader is waited for: one that is
/// slower than the sensor misses packets, and sees it by their numbers.
class LivePublisher final : public Publisher {
 public:
    LivePublisher(const disk::SensorConfig& config, StreamOutputs outputs, Pacer& pacer,
                  Clock& clock, FilterSwitch& filters, std::unique_ptr<LiveInput> input);
    ~LivePublisher() override { stop(); }
    LivePublisher(const LivePublisher&) = delete;
    LivePublisher& operator=(const LivePublisher&) = delete;

    void start() override;
    void stop() override;
    std::string remark() const override;
    std::vector<std::pair<std::string, std::uint64_t>> losses() const override;
    double drift_ppm() const override { return sink_.host_time().drift_ppm(); }

 private:
    void hear();
    void send();
    /// False when stopped.
    bool send(LiveItem& item);
    void count_dropped(const LiveItem& item);
    bool wait_for_subscribers();
    int subscribers_wanted() const { return static_cast<int>(config_.wait_for_subscribers()); }

    const disk::SensorConfig& config_;
    const StreamOutputs outputs_;
    Pacer& pacer_;
    Clock& clock_;
    LiveSink sink_;
    std::unique_ptr<LiveInput> input_;
    StopSignal stop_;

    // Of the sending thread.
    StreamSender sender_;
    std::int64_t tie_us_ = 0;  // a sensor time of the stream, and CLOCK_REALTIME of it
    std::int64_t tie_ns_ = 0;
    std::string fault_;                         // of the last stream
    std::atomic<std::uint64_t> unfiltered_{0};  // events that the filters did not fit

    std::thread hearing_;
    std::thread sending_;
};

}  // namespace pursuit::sensor
