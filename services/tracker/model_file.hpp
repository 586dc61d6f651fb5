// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "services/common/result.hpp"
#include "services/tracker/core/geometry/pose.hpp"
#include "services/tracker/core/geometry/shape.hpp"

namespace pursuit::tracker {

/// A shape as it is kept on disk.
struct ModelFile {
    Shape shape;  ///< About its centre of gravity.
    /// Where the centre of gravity was in the image that the model was made from.
    std::optional<Eigen::Vector2d> origin_px;
    std::string comment;
};

/// Reads a model: *.csv as points (columns x_px, y_px), with the contour edges (columns from, to)
/// of <stem>_edges.csv where that is beside it, and named by the stem without "model_" or
/// "model_true_"; anything else as Protobuf text (idl/model.proto). Errors name file, line and
/// cause; a shape that check() refuses is one.
Result<ModelFile> read_model_file(const std::string& path);

/// The files that read_model_file() reads: `path`, and that of the edges where it may be beside it.
std::vector<std::string> model_file_paths(const std::string& path);

/// Writes a model as Protobuf text, atomically.
Result<void> write_model_file(const std::string& path, const ModelFile& model);

/// A model and where it begins, as given on a command line: PATH[@x,y,theta[,scale]], px, rad.
struct ModelArgument {
    std::string path;
    std::optional<Pose> start;
};

/// What follows the last '@' is the start. An error names the argument and what is wrong in it.
Result<ModelArgument> parse_model_argument(const std::string& argument);

}  // namespace pursuit::tracker
