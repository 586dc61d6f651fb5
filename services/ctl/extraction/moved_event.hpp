// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace pursuit::ctl {

/// An event of the window that a model is made from.
struct MovedEvent {
    Eigen::Vector2f position_px;  ///< In the image.
    float phase;                  ///< Of the window: -0.5 at its start, 0 in its middle.
    std::uint8_t polarity;
};

}  // namespace pursuit::ctl
