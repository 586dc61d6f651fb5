// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/report/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "services/ctl/report/html.hpp"

namespace pursuit::ctl {
namespace {

constexpr double width = 460;
constexpr double height = 190;
constexpr double left = 52;
constexpr double right = 10;
constexpr double top = 26;
constexpr double bottom = 24;

/// A linear axis.
struct Axis {
    double low;
    double high;
    double from;  ///< In the drawing.
    double to;

    double at(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

Axis value_axis(const Plot& plot) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const auto& curve : plot.curves) {
        for (const auto& sample : curve.samples) {
            if (!std::isfinite(sample.value)) continue;
            low = std::min(low, sample.value);
            high = std::max(high, sample.value);
        }
    }
    if (plot.from_zero && low <= high) low = std::min(low, 0.0);
    const double margin = high > low ? 0.06 * (high - low) : std::max(1e-6, 0.05 * std::abs(high));
    const bool at_zero = plot.from_zero && low == 0;
    return {low - (at_zero ? 0 : margin), high + margin, height - bottom, top};
}

Axis time_axis(const Plot& plot) {
    const double begin = static_cast<double>(plot.begin_us) * 1e-6;
    const double end = static_cast<double>(plot.end_us) * 1e-6;
    return {begin, end > begin ? end : begin + 1e-3, left, width - right};
}

std::string line(double x1, double y1, double x2, double y2, const char* style) {
    return "<line class=\"" + std::string(style) + "\" x1=\"" + coordinate(x1) + "\" y1=\"" +
           coordinate(y1) + "\" x2=\"" + coordinate(x2) + "\" y2=\"" + coordinate(y2) + "\"/>";
}

std::string label(double x, double y, const char* style, const std::string& text) {
    return "<text class=\"" + std::string(style) + "\" x=\"" + coordinate(x) + "\" y=\"" +
           coordinate(y) + "\">" + text + "</text>";
}

/// A tick's value with the digits that its neighbours need.
std::string tick_text(double value, const std::vector<double>& all) {
    const double step = all.size() > 1 ? all[1] - all[0] : std::abs(value);
    if (std::abs(value) >= 1e4) return short_number(value);
    const int digits =
        step > 0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6) : 0;
    return number(value, digits);
}

std::string path_of(const std::vector<ReportSample>& samples, const Axis& time, const Axis& value) {
    std::string path;
    bool pen_down = false;
    for (const auto& sample : samples) {
        if (!std::isfinite(sample.value)) {
            pen_down = false;
            continue;
        }
        path += (pen_down ? "L" : "M") +
                coordinate(time.at(static_cast<double>(sample.t_us) * 1e-6)) + " " +
                coordinate(value.at(sample.value));
        pen_down = true;
    }
    return path;
}

}  // namespace

std::vector<ReportSample> thinned(const std::vector<ReportSample>& samples,
                                  std::size_t max_points) {
    if (samples.size() <= max_points) return samples;
    const std::size_t buckets = std::max<std::size_t>(max_points / 3, 1);
    std::vector<ReportSample> kept;
    for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
        const std::size_t begin = samples.size() * bucket / buckets;
        const std::size_t end = samples.size() * (bucket + 1) / buckets;
        std::size_t lowest = end;
        std::size_t highest = end;
        std::size_t gap = end;
        for (std::size_t i = begin; i < end; ++i) {
            if (!std::isfinite(samples[i].value)) {
                gap = i;
                continue;
            }
            if (lowest == end || samples[i].value < samples[lowest].value) lowest = i;
            if (highest == end || samples[i].value > samples[highest].value) highest = i;
        }
        std::array<std::size_t, 3> chosen = {lowest, highest, gap};
        std::sort(chosen.begin(), chosen.end());
        for (std::size_t k = 0; k < chosen.size(); ++k) {
            if (chosen[k] < end && (k == 0 || chosen[k] != chosen[k - 1])) {
                kept.push_back(samples[chosen[k]]);
            }
        }
    }
    return kept;
}

std::vector<double> ticks(double low, double high) {
    const double span = high - low;
    if (!(span > 0) || !std::isfinite(span)) return {};
    const double raw = span / 6;
    double step = std::pow(10, std::floor(std::log10(raw)));
    for (const double factor : {2.0, 2.5, 2.0}) {
        if (step >= raw) break;
        step *= factor;
    }
    std::vector<double> values;
    for (double i = std::ceil(low / step); i * step <= high + 1e-9 * step && values.size() < 7;
         ++i) {
        values.push_back(i * step);
    }
    return values;
}

std::string render_plot(const Plot& plot, const ReportLimits& limits) {
    const Axis time = time_axis(plot);
    const Axis value = value_axis(plot);
    const auto escaped = [&](const std::string& text) {
        return escape_html(text, limits.text_bytes);
    };
    std::string svg = "<svg class=\"plot\" viewBox=\"0 0 460 190\" role=\"img\" aria-label=\"" +
                      escaped(plot.title) + "\">";
    svg += label(left, 14, "title",
                 escaped(plot.title) + " <tspan class=\"unit\">" + escaped(plot.unit) + "</tspan>");
    if (!(value.low <= value.high)) {
        return svg + label(width / 2, height / 2, "none", "no values") + "</svg>";
    }
    for (const auto& shade : plot.shades) {
        const double begin =
            std::clamp(time.at(static_cast<double>(shade.begin_us) * 1e-6), left, width - right);
        const double end =
            std::clamp(time.at(static_cast<double>(shade.end_us) * 1e-6), left, width - right);
        svg += "<rect class=\"" + shade.style + "\" x=\"" + coordinate(begin) + "\" y=\"" +
               coordinate(top) + "\" width=\"" + coordinate(std::max(end - begin, 0.5)) +
               "\" height=\"" + coordinate(height - top - bottom) + "\"/>";
    }
    const auto value_ticks = ticks(value.low, value.high);
    for (const double tick : value_ticks) {
        svg += line(left, value.at(tick), width - right, value.at(tick), "grid");
        svg += label(left - 6, value.at(tick) + 3.5, "value", tick_text(tick, value_ticks));
    }
    const auto time_ticks = ticks(time.low, time.high);
    for (const double tick : time_ticks) {
        svg += line(time.at(tick), height - bottom, time.at(tick), height - bottom + 4, "axis");
        svg += label(time.at(tick), height - bottom + 16, "time",
                     tick_text(tick, time_ticks) + (tick == time_ticks.back() ? " s" : ""));
    }
    svg += line(left, height - bottom, width - right, height - bottom, "axis");
    for (const auto& curve : plot.curves) {
        const auto path = path_of(thinned(curve.samples, limits.curve_points), time, value);
        if (path.empty()) continue;
        svg += "<path class=\"curve " + curve.style + "\" d=\"" + path + "\"><title>" +
               escaped(curve.name) + "</title></path>";
    }
    // Moved by the page's script to the time of the picture that is shown.
    svg += "<line class=\"cursor\" y1=\"" + coordinate(top) + "\" y2=\"" +
           coordinate(height - bottom) + "\" x1=\"-9\" x2=\"-9\" data-begin=\"" +
           number(time.low, 6) + "\" data-end=\"" + number(time.high, 6) + "\" data-left=\"" +
           coordinate(left) + "\" data-right=\"" + coordinate(width - right) + "\"/>";
    return svg + "</svg>";
}

}  // namespace pursuit::ctl
