// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/ctl/report/report.hpp"

namespace pursuit::ctl {

/// A curve of a plot. `style` is a class of the page's style sheet.
struct PlotCurve {
    std::string name;
    std::string style;
    std::vector<ReportSample> samples;
};

/// An interval that is shaded, as while an object is lost.
struct PlotShade {
    std::int64_t begin_us = 0;
    std::int64_t end_us = 0;
    std::string style;
};

/// Values over time.
struct Plot {
    std::string title;
    std::string unit;
    std::vector<PlotCurve> curves;
    std::vector<PlotShade> shades;
    std::int64_t begin_us = 0;  ///< The time axis, the same for all plots of a page.
    std::int64_t end_us = 0;
    bool from_zero = false;  ///< The value axis begins at 0.
};

/// At most max_points samples with about the same picture: of each interval of time the lowest and
/// the highest value stay, and a gap stays a gap.
std::vector<ReportSample> thinned(const std::vector<ReportSample>& samples, std::size_t max_points);

/// Round values for the ticks of an axis, at most 7, within [low, high].
std::vector<double> ticks(double low, double high);

/// The plot as SVG. A plot without a finite value says so.
std::string render_plot(const Plot& plot, const ReportLimits& limits);

}  // namespace pursuit::ctl
