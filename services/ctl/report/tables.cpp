// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/report/tables.hpp"

#include <algorithm>
#include <cmath>

#include "services/ctl/report/html.hpp"

namespace pursuit::ctl {
namespace {

using State = ReportPose::State;

class Tables {
 public:
    Tables(const Report& report, const ReportLimits& limits) : report_(report), limits_(limits) {}

    std::string render() {
        objects();
        latencies_and_counts();
        facts();
        return std::move(html_);
    }

 private:
    std::string text(const std::string& s) const { return escape_html(s, limits_.text_bytes); }

    void objects() {
        html_ +=
            "<h2>Objects</h2>\n<div class=\"card wide\"><table><thead><tr><th>object</th>"
            "<th class=\"n\">id</th><th>result</th><th class=\"n\">E, px</th>"
            "<th class=\"n\">D1, px</th><th class=\"n\">largest error, px</th><th>lost</th>"
            "<th class=\"n\">lies</th><th class=\"n\">poses</th><th>state at the end</th>"
            "</tr></thead><tbody>\n";
        const auto rows = std::min(report_.objects.size(), limits_.table_rows);
        for (std::size_t i = 0; i < rows; ++i) {
            const auto& object = report_.objects[i];
            const auto own = verdict(object);
            const auto cell = [&](const std::string& content) {
                html_ += "<td class=\"n\">" + content + "</td>";
            };
            html_ += "<tr><td>" + text(object.name) + "</td>";
            cell(std::to_string(object.id));
            html_ += std::string("<td class=\"") + (own.good ? "good" : "bad") + "\">" +
                     text(own.text) + "</td>";
            cell(object.mean_error_px ? number(*object.mean_error_px, 3) : "–");
            cell(object.d1_px ? number(*object.d1_px, 3) : "–");
            cell(largest(object.error_px));
            html_ += "<td>" +
                     std::string(!object.lost   ? "–"
                                 : *object.lost ? "yes"
                                                : "no") +
                     "</td>";
            cell(object.lies ? std::to_string(*object.lies) : "–");
            cell(std::to_string(object.poses.size()));
            html_ += "<td>" + last_state(object) + "</td></tr>\n";
        }
        if (rows == 0) html_ += "<tr><td colspan=\"10\">no object was registered</td></tr>\n";
        html_ += "</tbody></table></div>\n";
    }

    void latencies_and_counts() {
        if (report_.latencies.empty() && report_.counts.empty()) return;
        html_ += "<h2>Latency and losses</h2>\n<div class=\"two\">\n";
        if (!report_.latencies.empty()) {
            html_ +=
                "<div class=\"card wide\"><table><thead><tr><th>latency, µs</th>"
                "<th class=\"n\">p50</th><th class=\"n\">p90</th><th class=\"n\">p99</th>"
                "<th class=\"n\">max</th><th class=\"n\">samples</th></tr></thead><tbody>\n";
            const auto rows = std::min(report_.latencies.size(), limits_.table_rows);
            for (std::size_t i = 0; i < rows; ++i) {
                const auto& row = report_.latencies[i];
                html_ += "<tr><td>" + text(row.name) + "</td>";
                for (const double value : {row.p50_us, row.p90_us, row.p99_us, row.max_us}) {
                    html_ += "<td class=\"n\">" + number(value, value < 100 ? 1 : 0) + "</td>";
                }
                html_ += "<td class=\"n\">" + std::to_string(row.samples) + "</td></tr>\n";
            }
            html_ += "</tbody></table></div>\n";
        }
        if (!report_.counts.empty()) {
            html_ +=
                "<div class=\"card wide\"><table><thead><tr><th>count</th><th class=\"n\"></th>"
                "</tr></thead><tbody>\n";
            const auto rows = std::min(report_.counts.size(), limits_.table_rows);
            for (std::size_t i = 0; i < rows; ++i) {
                const auto& row = report_.counts[i];
                const char* style = !row.is_loss ? "n" : row.count == 0 ? "n good" : "n bad";
                html_ += "<tr><td>" + text(row.name) + "</td><td class=\"" + style + "\">" +
                         std::to_string(row.count) + "</td></tr>\n";
            }
            html_ += "</tbody></table></div>\n";
        }
        html_ += "</div>\n";
    }

    void facts() {
        if (report_.facts.empty()) return;
        html_ +=
            "<h2>Versions and configuration</h2>\n<div class=\"card wide\"><table "
            "class=\"facts\"><tbody>\n";
        const auto rows = std::min(report_.facts.size(), limits_.table_rows);
        for (std::size_t i = 0; i < rows; ++i) {
            html_ += "<tr><th>" + text(report_.facts[i].first) + "</th><td>" +
                     text(report_.facts[i].second) + "</td></tr>\n";
        }
        html_ += "</tbody></table></div>\n";
    }

    static std::string largest(const std::vector<ReportSample>& errors) {
        double value = -1;
        for (const auto& error : errors) {
            if (std::isfinite(error.value)) value = std::max(value, error.value);
        }
        return value < 0 ? "–" : number(value, 2);
    }

    static std::string last_state(const ReportObject& object) {
        if (object.poses.empty()) return "no pose";
        switch (object.poses.back().state) {
            case State::searching:
                return "searching";
            case State::tracking:
                return "tracking";
            case State::occluded:
                return "occluded";
            case State::lost:
                return "lost";
        }
        return "";
    }

    const Report& report_;
    const ReportLimits& limits_;
    std::string html_;
};

}  // namespace

std::string render_tables(const Report& report, const ReportLimits& limits) {
    return Tables(report, limits).render();
}

}  // namespace pursuit::ctl
