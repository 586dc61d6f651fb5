// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/report/film.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/ctl/report/event_image.hpp"
#include "services/ctl/report/html.hpp"
#include "services/ctl/report/plot.hpp"

namespace pursuit::ctl {
namespace {

bool finite(const ReportPose& pose) {
    const std::array values = {pose.x_px, pose.y_px, pose.a00, pose.a01, pose.a10, pose.a11};
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

std::string point_text(const std::pair<double, double>& point) {
    return coordinate(point.first) + " " + coordinate(point.second);
}

/// The edges as one path, chains drawn in one stroke; dots where there are no edges or too many.
std::string shape_path(const ReportObject& object, std::size_t max_edges) {
    const auto& points = object.points_px;
    const auto usable = [&](std::size_t index) {
        return index < points.size() && std::isfinite(points[index].first) &&
               std::isfinite(points[index].second);
    };
    std::string path;
    if (object.edges.empty() || object.edges.size() > max_edges) {
        const std::size_t step = points.size() / std::max<std::size_t>(max_edges, 1) + 1;
        for (std::size_t i = 0; i < points.size(); i += step) {
            if (usable(i)) path += "M" + point_text(points[i]) + "h0";
        }
        return path;
    }
    std::size_t pen = points.size();
    for (const auto& [from, to] : object.edges) {
        if (!usable(from) || !usable(to)) continue;
        if (pen != from) path += "M" + point_text(points[from]);
        path += "L" + point_text(points[to]);
        pen = to;
    }
    return path;
}

std::string trajectory_path(const std::vector<ReportPose>& poses, std::size_t max_points) {
    // A curve in the plane: thinned evenly, which keeps its shape as long as it is smooth.
    const std::size_t step = poses.size() / std::max<std::size_t>(max_points, 1) + 1;
    std::string path;
    bool pen_down = false;
    for (std::size_t i = 0; i < poses.size(); i += step) {
        const auto& pose = poses[i];
        const bool shown = finite(pose) && pose.state != ReportPose::State::searching &&
                           pose.state != ReportPose::State::lost;
        if (shown) {
            path += (pen_down ? "L" : "M") + coordinate(pose.x_px) + " " + coordinate(pose.y_px);
        }
        pen_down = shown;
    }
    return path;
}

std::string placed(std::size_t object, const ReportPose& pose, const std::string& style) {
    std::string matrix;
    for (const double value : {pose.a00, pose.a10, pose.a01, pose.a11}) {
        matrix += number(value, 5) + " ";
    }
    return "<use href=\"#m" + std::to_string(object) + "\" class=\"" + style +
           "\" transform=\"matrix(" + matrix + coordinate(pose.x_px) + " " + coordinate(pose.y_px) +
           ")\"/>";
}

std::string frame(const Report& report, const Picture& picture, std::size_t index,
                  std::size_t objects) {
    const auto& slice = *picture.slice;
    const auto& size = report.geometry;
    const std::string w = std::to_string(size.width);
    const std::string h = std::to_string(size.height);
    const double begin_s = static_cast<double>(slice.begin_us) * 1e-6;
    const double end_s = static_cast<double>(slice.end_us) * 1e-6;
    std::string html = "<figure class=\"frame\" data-time=\"" + number(end_s, 6) +
                       "\" tabindex=\"0\" id=\"f" + std::to_string(index) +
                       "\"><svg viewBox=\"-0.5 -0.5 " + w + " " + h + "\" role=\"img\">";
    if (!picture.png.empty()) {
        html += "<image class=\"events\" x=\"-0.5\" y=\"-0.5\" width=\"" + w + "\" height=\"" + h +
                "\" href=\"data:image/png;base64," + picture.png + "\"/>";
    }
    for (std::size_t i = 0; i < objects; ++i) {
        const auto& object = report.objects[i];
        const std::string colour = "o" + std::to_string(i % 8);
        html += "<use href=\"#p" + std::to_string(i) + "\" class=\"trail " + colour + "\"/>";
        const auto* truth = pose_at(object.truth, slice.end_us);
        if (truth != nullptr && finite(*truth)) html += placed(i, *truth, "truth");
        const auto* pose = pose_at(object.poses, slice.end_us);
        if (pose == nullptr || !finite(*pose)) continue;
        if (pose->state == ReportPose::State::tracking) html += placed(i, *pose, "found " + colour);
        if (pose->state == ReportPose::State::occluded) {
            html += placed(i, *pose, "found occluded " + colour);
        }
    }
    return html + "</svg><figcaption>" + number(begin_s, 3) + " – " + number(end_s, 3) + " s, " +
           std::to_string(slice.events.size()) + " events</figcaption></figure>\n";
}

}  // namespace

const ReportPose* pose_at(const std::vector<ReportPose>& poses, std::int64_t t_us) {
    const auto after =
        std::upper_bound(poses.begin(), poses.end(), t_us,
                         [](std::int64_t t, const ReportPose& pose) { return t < pose.t_us; });
    return after == poses.begin() ? nullptr : &*std::prev(after);
}

std::string render_shapes(const Report& report, const ReportLimits& limits) {
    std::string svg = "<svg class=\"defs\" aria-hidden=\"true\"><defs>";
    const std::size_t objects = std::min(report.objects.size(), limits.objects);
    for (std::size_t i = 0; i < objects; ++i) {
        const auto& object = report.objects[i];
        svg += "<path id=\"m" + std::to_string(i) + "\" vector-effect=\"non-scaling-stroke\" d=\"" +
               shape_path(object, limits.model_edges) + "\"/>";
        svg += "<path id=\"p" + std::to_string(i) + "\" vector-effect=\"non-scaling-stroke\" d=\"" +
               trajectory_path(object.poses, limits.curve_points) + "\"/>";
    }
    return svg + "</defs></svg>\n";
}

std::vector<Picture> pictures_of(const Report& report, std::size_t count) {
    const std::size_t given = report.slices.size();
    const std::size_t shown = std::min(given, count);
    std::vector<Picture> pictures;
    for (std::size_t k = 0; k < shown; ++k) {
        const auto& slice = report.slices[shown == 1 ? given - 1 : k * (given - 1) / (shown - 1)];
        const auto png = event_png(slice.events, report.geometry);
        pictures.push_back({&slice, png ? base64(*png) : ""});
    }
    return pictures;
}

std::string render_film(const Report& report, const std::vector<Picture>& pictures,
                        const ReportLimits& limits) {
    const std::size_t objects = std::min(report.objects.size(), limits.objects);
    std::string html = "<div class=\"film\" id=\"film\">\n";
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        html += frame(report, pictures[i], i, objects);
    }
    return html + "</div>\n";
}

}  // namespace pursuit::ctl
