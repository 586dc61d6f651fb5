// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/report/report.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/atomic_file.hpp"
#include "services/ctl/report/film.hpp"
#include "services/ctl/report/html.hpp"
#include "services/ctl/report/plot.hpp"
#include "services/ctl/report/style.hpp"
#include "services/ctl/report/tables.hpp"

namespace pursuit::ctl {
namespace {

using State = ReportPose::State;

/// One page being written.
class Page {
 public:
    Page(const Report& report, const ReportLimits& limits, const std::vector<Picture>& film)
        : report_(report),
          limits_(limits),
          objects_(std::min(report.objects.size(), limits.objects)),
          film_(film) {
        find_times();
    }

    std::string render() {
        html_ =
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>" +
            text(report_.title) + "</title>\n<style>";
        html_ += report_style;
        html_ += "</style>\n</head>\n<body>\n<main>\n";
        head();
        pictures();
        trajectories();
        rates();
        html_ += render_tables(report_, limits_);
        left_out();
        html_ += "</main>\n<script>";
        html_ += report_script;
        html_ += "</script>\n</body>\n</html>\n";
        return std::move(html_);
    }

 private:
    std::string text(const std::string& s) const { return escape_html(s, limits_.text_bytes); }

    static std::string colour(std::size_t object) { return "o" + std::to_string(object % 8); }

    void find_times() {
        bool any = false;
        const auto widen = [&](std::int64_t t_us) {
            begin_us_ = any ? std::min(begin_us_, t_us) : t_us;
            end_us_ = any ? std::max(end_us_, t_us) : t_us;
            any = true;
        };
        for (const auto& object : report_.objects) {
            for (const auto* poses : {&object.poses, &object.truth}) {
                if (poses->empty()) continue;
                widen(poses->front().t_us);
                widen(poses->back().t_us);
            }
        }
        for (const auto& slice : report_.slices) widen(slice.end_us);
        for (const auto& curve : report_.curves) {
            if (curve.samples.empty()) continue;
            widen(curve.samples.front().t_us);
            widen(curve.samples.back().t_us);
        }
    }

    void head() {
        const auto all = verdict(report_);
        html_ += "<h1>" + text(report_.title) + "</h1>\n<p class=\"soft\">" +
                 text(report_.subtitle) + "</p>\n<p class=\"verdict " +
                 (all.good ? "good" : "bad") + "\">" + text(all.text) + "</p>\n";
        html_ += "<div class=\"chips\">\n";
        for (std::size_t i = 0; i < objects_; ++i) {
            const auto& object = report_.objects[i];
            const auto own = verdict(object);
            html_ += "<div class=\"card chip " + colour(i) + "\"><b>" + text(object.name) +
                     "</b><span class=\"" + (own.good ? "good" : "bad") + "\">" + text(own.text) +
                     "</span>";
            if (object.mean_error_px) {
                html_ += "<br/><span class=\"big\">" + number(*object.mean_error_px, 2) +
                         " px</span> <span class=\"soft\">mean error E</span>";
            }
            html_ += "</div>\n";
        }
        html_ += "</div>\n";
    }

    void pictures() {
        html_ += render_shapes(report_, limits_);
        if (film_.empty()) return;
        html_ +=
            "<h2>What was seen, and where the objects were found</h2>\n<div class=\"key\">"
            "<span><i class=\"box on\"></i>brighter (ON)</span>"
            "<span><i class=\"box off\"></i>darker (OFF)</span>";
        for (std::size_t i = 0; i < objects_; ++i) {
            html_ += "<span class=\"" + colour(i) + "\"><i></i>" + text(report_.objects[i].name) +
                     "</span>";
        }
        html_ +=
            "<span><i class=\"dash\"></i>while occluded</span>"
            "<span><i class=\"dots\"></i>truth</span></div>\n"
            "<div class=\"card\"><figure class=\"viewer\" id=\"viewer\"><div id=\"picture\"></div>"
            "<figcaption id=\"caption\"></figcaption><div class=\"play\">"
            "<button type=\"button\" id=\"play\">Play</button>"
            "<input type=\"range\" id=\"slider\" min=\"0\" value=\"0\" step=\"1\" "
            "aria-label=\"picture\"/></div></figure>\n";
        html_ += render_film(report_, film_, limits_);
        html_ += "</div>\n";
    }

    void trajectories() {
        if (objects_ == 0) return;
        html_ +=
            "<h2>Trajectories</h2>\n<div class=\"key\"><span><i></i>truth</span>"
            "<span><i style=\"border-color:var(--soft)\"></i>found, in the object's colour</span>"
            "<span><i class=\"box shade-occluded\"></i>occluded</span>"
            "<span><i class=\"box shade-lost\"></i>searching or lost</span></div>\n";
        for (std::size_t i = 0; i < objects_; ++i) {
            const auto& object = report_.objects[i];
            html_ += "<div class=\"card plots " + colour(i) + "\">\n";
            const auto component = [&](const char* name, double ReportPose::*member) {
                Plot plot = empty_plot(object.name + ", " + name, "px");
                plot.shades = shades(object);
                plot.curves.push_back({"truth", "true", samples(object.truth, member, false)});
                plot.curves.push_back({"found", colour(i), samples(object.poses, member, true)});
                html_ += render_plot(plot, limits_) + "\n";
            };
            component("x", &ReportPose::x_px);
            component("y", &ReportPose::y_px);
            if (!object.error_px.empty()) {
                Plot plot = empty_plot(object.name + ", error", "px");
                plot.shades = shades(object);
                plot.from_zero = true;
                plot.curves.push_back({"error", colour(i), object.error_px});
                html_ += render_plot(plot, limits_) + "\n";
            }
            html_ += "</div>\n";
        }
    }

    void rates() {
        std::vector<std::string> units;
        for (const auto& curve : report_.curves) {
            if (std::find(units.begin(), units.end(), curve.unit) == units.end()) {
                units.push_back(curve.unit);
            }
        }
        units.resize(std::min<std::size_t>(units.size(), 6));
        if (units.empty()) return;
        html_ += "<h2>Rates</h2>\n<div class=\"card plots\">\n";
        for (const auto& unit : units) {
            Plot plot = empty_plot("", unit);
            plot.from_zero = true;
            std::string key;
            std::size_t colour_index = 5;
            for (const auto& curve : report_.curves) {
                if (curve.unit != unit || plot.curves.size() == 8) continue;
                plot.title += (plot.title.empty() ? "" : ", ") + curve.name;
                plot.curves.push_back({curve.name, colour(colour_index), curve.samples});
                key += "<span class=\"" + colour(colour_index) + "\"><i></i>" + text(curve.name) +
                       "</span>";
                ++colour_index;
            }
            html_ += "<div>" + render_plot(plot, limits_);
            if (plot.curves.size() > 1) html_ += "<div class=\"key\">" + key + "</div>";
            html_ += "</div>\n";
        }
        html_ += "</div>\n";
    }

    /// What the bounds of the page have cost.
    void left_out() {
        std::string said;
        const auto say = [&](std::size_t shown, std::size_t given, const char* what) {
            if (shown < given) {
                said += " " + std::to_string(shown) + " of " + std::to_string(given) + " " + what +
                        " are shown.";
            }
        };
        say(film_.size(), report_.slices.size(), "pictures");
        say(objects_, report_.objects.size(), "objects with curves and outlines");
        say(std::min(report_.objects.size(), limits_.table_rows), report_.objects.size(),
            "rows of the table of objects");
        say(std::min(report_.latencies.size(), limits_.table_rows), report_.latencies.size(),
            "latencies");
        say(std::min(report_.counts.size(), limits_.table_rows), report_.counts.size(), "counts");
        say(std::min(report_.facts.size(), limits_.table_rows), report_.facts.size(), "facts");
        bool thin = false;
        for (const auto& object : report_.objects) {
            for (const std::size_t size :
                 {object.poses.size(), object.truth.size(), object.error_px.size()}) {
                thin = thin || size > limits_.curve_points;
            }
        }
        for (const auto& curve : report_.curves) {
            thin = thin || curve.samples.size() > limits_.curve_points;
        }
        if (thin) {
            said += " Curves have at most " + std::to_string(limits_.curve_points) +
                    " points: the lowest and highest value of each interval.";
        }
        if (!said.empty()) {
            html_ += "<p class=\"soft\">To keep this page small:" + said +
                     " The numbers in the tables are of all data.</p>\n";
        }
    }

    Plot empty_plot(std::string title, std::string unit) const {
        Plot plot;
        plot.title = std::move(title);
        plot.unit = std::move(unit);
        plot.begin_us = begin_us_;
        plot.end_us = end_us_;
        return plot;
    }

    static std::vector<ReportSample> samples(const std::vector<ReportPose>& poses,
                                             double ReportPose::*member, bool by_state) {
        std::vector<ReportSample> result;
        result.reserve(poses.size());
        for (const auto& pose : poses) {
            const bool none =
                by_state && (pose.state == State::searching || pose.state == State::lost);
            result.push_back({pose.t_us, none ? std::nan("") : pose.*member});
        }
        return result;
    }

    /// The intervals in which the object was not tracked, at most 400.
    static std::vector<PlotShade> shades(const ReportObject& object) {
        std::vector<PlotShade> result;
        const auto& poses = object.poses;
        for (std::size_t i = 0; i < poses.size() && result.size() < 400;) {
            std::size_t end = i;
            while (end < poses.size() && poses[end].state == poses[i].state) ++end;
            if (poses[i].state != State::tracking) {
                result.push_back(
                    {poses[i].t_us, poses[std::min(end, poses.size() - 1)].t_us,
                     poses[i].state == State::occluded ? "shade-occluded" : "shade-lost"});
            }
            i = end;
        }
        return result;
    }

    const Report& report_;
    const ReportLimits& limits_;
    std::size_t objects_;
    const std::vector<Picture>& film_;
    std::int64_t begin_us_ = 0;
    std::int64_t end_us_ = 0;
    std::string html_;
};

}  // namespace

std::string render_report(const Report& report, const ReportLimits& limits) {
    auto film = pictures_of(report, limits.slices);
    for (;;) {
        auto page = Page(report, limits, film).render();
        if (page.size() <= limits.page_bytes || film.empty()) return page;
        std::vector<Picture> fewer;
        for (std::size_t i = 1; i < film.size(); i += 2) fewer.push_back(std::move(film[i]));
        film = std::move(fewer);
    }
}

Result<void> write_report(const std::string& path, const Report& report,
                          const ReportLimits& limits) {
    return write_output(path, render_report(report, limits));
}

}  // namespace pursuit::ctl
