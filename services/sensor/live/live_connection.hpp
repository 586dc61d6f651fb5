// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "services/sensor/formats/byte_source.hpp"
#include "services/sensor/live/stop_signal.hpp"

namespace pursuit::sensor {

/// Where live bytes come from: "-" standard input, "tcp://host:port" a peer to connect to (an IPv6
/// address in brackets), anything else the path of a FIFO or a character device.
struct LiveAddress {
    enum class Kind { standard_input, path, tcp };
    Kind kind = Kind::path;
    std::string text;  ///< As it was given; errors call it so.
    std::string host;
    std::string port;
};

Result<LiveAddress> parse_live_address(const std::string& text);

/// Connects, or opens. The source's read() waits until bytes come, and ends when `stop` is raised
/// or the peer closes; `stop` must outlive it.
///
/// - TCP: waits for the resolver, then up to 2 s for the peer. Keepalive finds out within 8 s that
///   its host is gone; a peer that is only silent is waited for.
/// - A FIFO is opened whether or not somebody writes; its stream ends with its last writer.
/// - A terminal device is set to pass bytes through unchanged, at the speed that it has.
/// - A regular file is refused: that is a recording.
Result<std::unique_ptr<ByteSource>> connect_live(const LiveAddress& address,
                                                 const StopSignal& stop);

}  // namespace pursuit::sensor
