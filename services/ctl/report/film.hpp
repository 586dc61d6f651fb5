// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "services/ctl/report/report.hpp"

namespace pursuit::ctl {

/// The shapes of the first limits.objects objects as SVG <defs>, once for the page: "m0", "m1", …
/// in the model frame, and their trajectories "p0", … in the image frame.
std::string render_shapes(const Report& report, const ReportLimits& limits);

/// A slice and its events as a PNG in base64, empty where it has no pixels.
struct Picture {
    const ReportSlice* slice = nullptr;
    std::string png;
};

/// At most `count` slices, spread evenly, the first and the last among them.
std::vector<Picture> pictures_of(const Report& report, std::size_t count);

/// The pictures as a strip: events, and over them each object's outline where it was found at the
/// slice's end (dashed while occluded, absent while searching or lost) and, dotted, where it was by
/// the truth.
std::string render_film(const Report& report, const std::vector<Picture>& pictures,
                        const ReportLimits& limits);

/// The last pose at or before t_us; null where there is none.
const ReportPose* pose_at(const std::vector<ReportPose>& poses, std::int64_t t_us);

}  // namespace pursuit::ctl
