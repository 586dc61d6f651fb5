// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "services/common/result.hpp"

namespace pursuit::ctl {

/// x_px, y_px, a00, a01, a10, a11
using PoseNumbers = std::array<double, 6>;

/// The rows of one object in a table of poses or of truth, in order of time; one entry a row.
struct ObjectRows {
    std::string model;
    std::string object_id;
    std::vector<double> t_us;
    std::vector<PoseNumbers> pose;   ///< NaN where the row has no value.
    std::vector<std::string> state;  ///< "TRACKING" where the table has none.
    std::vector<double> confidence;  ///< 1 where the table has none.
    std::vector<double> visible;     ///< visible_fraction; 1 where the table has none.
};

/// Reads a table of poses or of truth, columns found by name. Needed are t_us, x_px, y_px and the
/// matrix, a00 to a11; where there is no a00 it is made of theta_rad and, where they are there,
/// scale_x and scale_y. A row that ends before the last column is an error, as is a state that is
/// none. Objects in the order in which they first occur. Errors name file, line and column.
Result<std::vector<ObjectRows>> read_object_rows(const std::string& path);

/// Rotation of the polar decomposition, -π … π.
double angle_rad(const PoseNumbers& pose);

}  // namespace pursuit::ctl
