// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace pursuit::recorder {

/// Numbers the event streams of each sensor of a recording from 0, in the order in which they
/// begin. Event time begins anew with each stream, so the place of a call is a stream and a time.
/// Threads: one.
class SensorStreams {
 public:
    /// True where the packet is the first of its stream.
    bool take(std::uint32_t sensor_id, std::uint64_t stream_id) {
        if (!first_sensor_) first_sensor_ = sensor_id;
        auto& known = streams_[sensor_id];
        if (std::find(known.begin(), known.end(), stream_id) != known.end()) return false;
        known.push_back(stream_id);
        return true;
    }

    /// The number of the stream that began last; 0 before any. Where the sensor is not known: that
    /// of first_sensor().
    std::size_t current(std::optional<std::uint32_t> sensor_id) const {
        if (!sensor_id) sensor_id = first_sensor_;
        const auto known = sensor_id ? streams_.find(*sensor_id) : streams_.end();
        return known == streams_.end() ? 0 : known->second.size() - 1;
    }

    /// The sensor heard first.
    std::optional<std::uint32_t> first_sensor() const { return first_sensor_; }

 private:
    std::map<std::uint32_t, std::vector<std::uint64_t>> streams_;  ///< By sensor; ids, none empty.
    std::optional<std::uint32_t> first_sensor_;
};

}  // namespace pursuit::recorder
