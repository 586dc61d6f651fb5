// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "services/common/output_file.hpp"
#include "services/common/result.hpp"
#include "services/tracker/core/pose_record.hpp"

namespace pursuit::ctl {

/// One pose as a row of a table, whether it came from the tracker in this process or over DDS.
struct PoseRow {
    std::int64_t t_us = 0;
    std::int64_t last_event_t_us = 0;
    std::uint32_t object_id = 0;
    std::string model;
    tracker::TrackState state = tracker::TrackState::searching;
    tracker::Pose pose;
    double theta_rad = 0;
    double scale_x = 1;
    double scale_y = 1;
    double vx_px_s = 0;
    double vy_px_s = 0;
    double omega_rad_s = 0;
    float confidence = 0;
    float residual_px = 0;

    friend bool operator==(const PoseRow&, const PoseRow&) = default;
};

PoseRow row_of(const tracker::PoseRecord& record);

/// The line of column names, with its end.
extern const std::string_view pose_csv_header;

/// Appends a row with its end. Every number is the shortest text that reads back as the same bits:
/// equal files are equal poses.
void append_pose_csv(std::string& text, const PoseRow& row);

/// A table of poses being written; whole only when close() has succeeded.
class PoseCsvWriter {
 public:
    static Result<PoseCsvWriter> create(const std::string& path);

    Result<void> write(const PoseRow& row);
    Result<void> close() { return file_.close(); }

 private:
    explicit PoseCsvWriter(OutputFile file) : file_(std::move(file)) {}

    OutputFile file_;
    std::string line_;
};

/// Reads a table of poses with all its columns, in the order of the file. Errors name file, line
/// and column.
Result<std::vector<PoseRow>> read_pose_csv(const std::string& path);

}  // namespace pursuit::ctl
