// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "poses.h"
#include "services/ctl/pose_csv.hpp"

namespace pursuit::ctl {

/// The row of a pose that came over DDS: the same bits as the tracker's own record.
PoseRow row_of(const v1::ObjectPose& pose);

/// Every field of a pose as one JSON object, named as in idl/poses.idl; covariances as arrays.
std::string pose_json(const v1::ObjectPose& pose);

/// Counts poses, and breaks of their sequence numbers object by object. A number that goes back is
/// a tracker that was started again, not a loss.
class PoseCounter {
 public:
    void add(const v1::ObjectPose& pose);

    [[nodiscard]] std::uint64_t poses() const { return poses_; }
    [[nodiscard]] std::uint64_t gaps() const { return gaps_; }
    [[nodiscard]] std::uint64_t missed() const { return missed_; }

 private:
    using Object = std::pair<std::uint32_t, std::uint32_t>;  // sensor id, object id
    std::map<Object, std::uint64_t> last_;
    std::uint64_t poses_ = 0;
    std::uint64_t gaps_ = 0;
    std::uint64_t missed_ = 0;
};

/// The latest pose of every object, a line each: drawn over itself on a terminal.
class PoseTable {
 public:
    explicit PoseTable(bool terminal) : terminal_(terminal) {}

    void add(const v1::ObjectPose& pose);
    /// Whether it is time to draw something new.
    bool due(std::chrono::steady_clock::time_point now);
    std::string text();

 private:
    struct Entry {
        v1::ObjectPose pose;
        std::uint64_t count = 0;
    };
    bool terminal_;
    bool changed_ = false;
    std::size_t lines_drawn_ = 0;
    std::chrono::steady_clock::time_point drawn_{};
    std::map<std::pair<std::uint32_t, std::uint32_t>, Entry> objects_;
};

}  // namespace pursuit::ctl
