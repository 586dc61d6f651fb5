// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/extraction/extract_model.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>
#include <vector>

#include "services/ctl/extraction/contour_links.hpp"
#include "services/ctl/extraction/dominant_motion.hpp"
#include "services/ctl/extraction/edge_points.hpp"
#include "services/ctl/extraction/moved_event.hpp"
#include "services/ctl/extraction/thinning.hpp"

namespace pursuit::ctl {
namespace {

constexpr std::size_t most_events = 10'000'000;  // a bound on memory; a window has thousands

bool is_inside(const Event& event, const Extraction& task) {
    return event.x >= task.x_px && event.y >= task.y_px &&
           (task.width_px == 0 || event.x < task.x_px + task.width_px) &&
           (task.height_px == 0 || event.y < task.y_px + task.height_px);
}

Result<std::vector<MovedEvent>> read_window(sensor::EventReader& recording,
                                            const Extraction& task) {
    const auto end_us = task.start_us + task.window_us;
    std::vector<MovedEvent> window;
    std::vector<Event> block(4096);
    for (;;) {
        const auto count = recording.read(block);
        if (!count) return tl::unexpected(count.error());
        for (std::size_t i = 0; i < *count; ++i) {
            const auto& event = block[i];
            if (event.t_us >= end_us) return window;
            if (event.t_us < task.start_us || !is_inside(event, task)) continue;
            if (window.size() == most_events)
                return fail("more than 10 million events: shorten the window");
            const auto phase = static_cast<float>(event.t_us - task.start_us) /
                                   static_cast<float>(task.window_us) -
                               0.5F;
            window.push_back({{static_cast<float>(event.x), static_cast<float>(event.y)},
                              phase,
                              event.polarity});
        }
        if (*count == 0) return window;
    }
}

Result<void> check_task(const Extraction& task, Geometry geometry) {
    if (task.start_us < 0 || task.window_us < 1) {
        return fail("the window must begin at 0 or later and be longer than 0");
    }
    if (task.points < tracker::min_shape_points || task.points > tracker::max_shape_points) {
        return fail("points: must be 3 to 4096");
    }
    if (task.x_px < 0 || task.y_px < 0 || task.width_px < 0 || task.height_px < 0 ||
        task.x_px >= geometry.width || task.y_px >= geometry.height) {
        return fail("the rectangle must begin within the image of " +
                    std::to_string(geometry.width) + "x" + std::to_string(geometry.height));
    }
    return tracker::check_name(task.name);
}

/// Links between points of one polarity, told by events of that polarity.
std::vector<tracker::Edge> links_of(const std::vector<EdgePoint>& points,
                                    const std::array<std::vector<Eigen::Vector2f>, 2>& still_px) {
    std::vector<tracker::Edge> links;
    for (std::size_t polarity = 0; polarity < still_px.size(); ++polarity) {
        std::vector<std::uint16_t> index;
        std::vector<Eigen::Vector2f> points_px;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (points[i].polarity != polarity) continue;
            index.push_back(static_cast<std::uint16_t>(i));
            points_px.push_back(points[i].position_px);
        }
        for (const auto& link : contour_links(points_px, still_px[polarity])) {
            if (links.size() == tracker::max_shape_edges) return links;
            links.push_back({index[link.from], index[link.to]});
        }
    }
    return links;
}

std::string remark_of(const ExtractedModel& extracted, const Extraction& task) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "from %zu events of %.6f s to %.6f s, moving at (%.0f, %.0f) px/s",
                  extracted.events, static_cast<double>(task.start_us) * 1e-6,
                  static_cast<double>(task.start_us + task.window_us) * 1e-6,
                  static_cast<double>(extracted.velocity_px_s.x()),
                  static_cast<double>(extracted.velocity_px_s.y()));
    return text;
}

}  // namespace

Result<ExtractedModel> extract_model(sensor::EventReader& recording, const Extraction& task) {
    if (auto ok = check_task(task, recording.geometry()); !ok) return tl::unexpected(ok.error());
    const auto window = read_window(recording, task);
    if (!window) return tl::unexpected(window.error());

    ExtractedModel extracted;
    extracted.events = window->size();
    const auto motion_px = dominant_motion_px(*window);
    extracted.velocity_px_s = motion_px * (1e6F / static_cast<float>(task.window_us));
    // An edge makes events of one polarity: what runs close beside it is told apart by the other.
    std::array<std::vector<Eigen::Vector2f>, 2> still_px;
    for (const auto& event : *window) {
        still_px[event.polarity & 1].push_back(event.position_px - event.phase * motion_px);
    }
    std::vector<EdgePoint> edges = edge_points(still_px[0], 0);
    const std::vector<EdgePoint> on = edge_points(still_px[1], 1);
    edges.insert(edges.end(), on.begin(), on.end());
    std::sort(edges.begin(), edges.end(), ranks_before);
    const std::vector<EdgePoint> chosen = thin(edges, task.points);

    auto& model = extracted.model;
    model.shape.name = task.name;
    for (const EdgePoint& point : chosen) model.shape.points_px.push_back(point.position_px);
    if (model.shape.points_px.size() < tracker::min_shape_points) {
        return fail("only " + std::to_string(window->size()) +
                    " events moved there then: too few for a model");
    }
    if (auto ok = tracker::check(model.shape); !ok) return tl::unexpected(ok.error());
    if (task.links) model.shape.edges = links_of(chosen, still_px);
    model.origin_px = tracker::centre_of_gravity_px(model.shape);
    model.shape = tracker::centred(std::move(model.shape));
    model.comment = remark_of(extracted, task);
    return extracted;
}

}  // namespace pursuit::ctl
