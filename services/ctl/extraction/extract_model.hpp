// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>

#include "services/common/event.hpp"
#include "services/common/result.hpp"
#include "services/sensor/formats/event_reader.hpp"
#include "services/tracker/model_file.hpp"

namespace pursuit::ctl {

/// What to make a model from: the events of a rectangle of the image within a window of time.
struct Extraction {
    std::string name;           ///< Of the model.
    std::int64_t start_us = 0;  ///< Of the recording's time.
    std::int64_t window_us = 20'000;
    int x_px = 0;  ///< The rectangle's first column and row …
    int y_px = 0;
    int width_px = 0;  ///< … and size; 0: the whole image.
    int height_px = 0;
    std::size_t points = 300;  ///< At most, 3 … 4096.
    bool links = true;         ///< Tell which points a contour joins.
};

struct ExtractedModel {
    /// The shape at the window's middle; origin_px says where its centre of gravity was then.
    tracker::ModelFile model;
    std::size_t events = 0;           ///< In window and rectangle.
    Eigen::Vector2f velocity_px_s{};  ///< Of the shape during the window.
};

/// A model of what moved. The same events give the same model.
///
/// 1. The shape's own motion during the window is found and taken back (dominant_motion.hpp).
/// 2. Isolated events are left out, the rest thinned to the middle of its edges (edge_points.hpp).
/// 3. Points are taken evenly along them, corners first (thinning.hpp).
/// 4. Those that a contour joins are linked (contour_links.hpp).
///
/// An error where too few events moved for 3 points, or the events end in one.
Result<ExtractedModel> extract_model(sensor::EventReader& recording, const Extraction& task);

}  // namespace pursuit::ctl
