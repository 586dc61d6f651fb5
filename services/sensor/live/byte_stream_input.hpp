// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "services/sensor/formats/formats.hpp"
#include "services/sensor/live/live_connection.hpp"
#include "services/sensor/live/live_input.hpp"

namespace pursuit::sensor {

/// A stream of bytes in a known format, as a camera's driver or an FPGA writes it: from standard
/// input, a FIFO, a device or a TCP peer.
///
///   connecting ──► hearing ──► (the peer closes, or its bytes make no sense) ──► back-off ─┐
///       ▲                                                                                  │
///       └──────────────────────────────────────────────────────────────────────────────────┘
///
/// Bytes are decoded on the thread that reads them, before they wait for anything: decoding is
/// quicker than any bus, so that it is events that are dropped and counted when the queue is full,
/// and a decoder never has to find its way into the middle of a stream again. A peer that sends
/// faster than this thread can decode is slowed down by TCP itself. Each connection is a stream of
/// its own, because the sensor's time may begin anew with it. Standard input has only one.
class ByteStreamInput final : public LiveInput {
 public:
    ByteStreamInput(LiveAddress address, ReadOptions format,
                    std::chrono::milliseconds longest_wait);

    void run(LiveSink& sink, const StopSignal& stop) override;

 private:
    /// One connection, to its end.
    void hear(std::unique_ptr<ByteSource> source, LiveSink& sink, const StopSignal& stop);

    LiveAddress address_;
    ReadOptions format_;
    std::chrono::milliseconds longest_wait_;
    std::vector<Event> events_;
    std::vector<Event> exposures_;
};

}  // namespace pursuit::sensor
