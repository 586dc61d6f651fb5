// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <google/protobuf/message.h>

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "services/common/participant.hpp"
#include "status.h"

namespace pursuit {

/// What every status has in common: version, state, the last error, how many there were, and the
/// state of this host's clock. Threads: any.
class Health {
 public:
    /// `configuration` is digested so that two runs can be told apart.
    explicit Health(const google::protobuf::Message& configuration);

    void state(v1::ServiceState state, const std::string& detail);
    /// Logs the error, counts it and keeps it for the status.
    void error(const std::string& message);
    std::uint64_t errors() const { return errors_.load(); }

    /// The status part of now; `counts` of the participant.
    v1::ServiceHealth snapshot(const TransportCounts& counts) const;

 private:
    mutable std::mutex mutex_;
    v1::ServiceState state_ = v1::SERVICE_STARTING;
    std::string detail_;
    std::string last_error_;
    std::int64_t last_error_host_time_ns_ = 0;
    std::atomic<std::uint64_t> errors_{0};
    std::string configuration_digest_;
    std::int64_t start_host_time_ns_;
};

/// Adds to the counts of a status what its participant counted of peers.
void count_peers(const TransportCounts& counts, std::vector<v1::NamedCount>& dropped_by);

/// `text` cut to at most `bytes` bytes, as IDL string bounds demand.
std::string bounded(const std::string& text, std::size_t bytes);

/// The version that every status and --version carry.
const char* version();

}  // namespace pursuit
