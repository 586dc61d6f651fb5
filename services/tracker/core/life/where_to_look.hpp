// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/geometry/coast.hpp"
#include "services/tracker/core/geometry/contour.hpp"
#include "services/tracker/core/life/doubt.hpp"
#include "services/tracker/core/search/shape_search.hpp"

namespace pursuit::tracker {

/// To confirm where an object is thought to be, and how it goes: around it, and, where it fell
/// silent, around where it may have gone since (for coast_s at most). `known`: the last pose that
/// was believed before; every other check looks for a shape as large, and as drawn out, as it was
/// there: with the wrong edges an estimator may have stretched it to what it holds on to.
SearchRange range_of_check(std::int64_t t_us, const Coast& own, const Doubt& doubt,
                           const Pose& known, double coast_s);

/// A pose as it would be were the contour stretched or pressed along one of its axes, with one of
/// its ends where it is: an affine estimator that held on to some of the edges may have done that.
std::vector<Pose> stretched_poses(const Contour& contour, const Pose& own);

/// What such a search says. `checked`: where the object was thought to be, and how much of the
/// contour that place explains.
Doubt::Finding compare(const Contour& contour, const std::optional<ShapeSearch::Found>& found,
                       const Pose& checked, double own_score);

/// For an object that was lost gap_s ago: around where it would be now, going on as it did.
SearchRange range_near(const Coast& coasted, double gap_s, bool has_fixed_scale);

/// Anywhere in the image. `around` gives the size, and what angles are preferred.
SearchRange range_of_image(const Pose& around, Geometry geometry, bool has_fixed_scale);

/// For an object that a new stream left anywhere, adrift_s ago: farther about, the longer ago.
/// What looks the same and was far away is taken only when nothing is found near.
SearchRange range_adrift(const Pose& last, double adrift_s, Geometry geometry,
                         bool has_fixed_scale);

}  // namespace pursuit::tracker
