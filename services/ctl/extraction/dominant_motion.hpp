// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "services/ctl/extraction/moved_event.hpp"

namespace pursuit::ctl {

/// How far the shape moved during the window, px: the displacement that, taken back from each event
/// by its phase, stacks events of one polarity best (greatest sum of squared counts per pixel;
/// G. Gallego et al., "A unifying contrast maximization framework", CVPR 2018, with the variance of
/// the image of warped events). Within ±16 px in x and in y; zero where no motion stacks them at
/// least 10 % better than none, as for a turning shape.
Eigen::Vector2f dominant_motion_px(std::span<const MovedEvent> events);

}  // namespace pursuit::ctl
