// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/common/event.hpp"
#include "services/common/result.hpp"

/// One HTML page about a run: what was seen, what was tracked, how well. It needs nothing else (no
/// network, no other file), follows the reader's light or dark setting, and is small whatever it is
/// given: what it leaves out it says.
namespace pursuit::ctl {

/// image_from_model at one time, as in the poses and truth tables: p = (x_px, y_px) + A m.
struct ReportPose {
    enum class State { searching, tracking, occluded, lost };

    std::int64_t t_us = 0;
    double x_px = 0;
    double y_px = 0;
    double a00 = 1;
    double a01 = 0;
    double a10 = 0;
    double a11 = 1;
    State state = State::tracking;  ///< Not looked at in a truth.
};

/// A value at a time, for curves. A value that is not finite is a gap in the curve.
struct ReportSample {
    std::int64_t t_us = 0;
    double value = 0;
};

/// An object: its shape, where it was found, where it really was.
struct ReportObject {
    std::string name;
    std::uint32_t id = 0;
    std::vector<std::pair<double, double>> points_px;  ///< The model, about its centre of gravity.
    std::vector<std::pair<std::uint16_t, std::uint16_t>>
        edges;  ///< Indices; empty: dots are drawn.

    std::vector<ReportPose> poses;        ///< In order of time; may be empty.
    std::vector<ReportPose> truth;        ///< Likewise; empty where there is none.
    std::vector<ReportSample> error_px;   ///< rms distance of the model points to the truth.
    std::optional<double> mean_error_px;  ///< E.
    std::optional<double> d1_px;          ///< The paper's measure.
    std::optional<bool> lost;             ///< By the truth; absent: by the state of the last pose.
    std::optional<std::uint64_t> lies;    ///< Confident poses that were wrong.
};

/// The events of an interval, drawn as one picture with the outlines of its end over it.
struct ReportSlice {
    std::int64_t begin_us = 0;
    std::int64_t end_us = 0;
    std::vector<Event> events;  ///< Those outside the geometry are not drawn.
};

/// A curve of the section "Rates"; all curves of one unit share a plot.
struct ReportCurve {
    std::string name;
    std::string unit;  ///< As "events/s".
    std::vector<ReportSample> samples;
};

/// A row of the latency table, µs.
struct ReportLatency {
    std::string name;
    double p50_us = 0;
    double p90_us = 0;
    double p99_us = 0;
    double max_us = 0;
    std::uint64_t samples = 0;
};

/// A row of the table of counts. A loss is marked where it is not 0, and is part of the verdict.
struct ReportCount {
    std::string name;
    std::uint64_t count = 0;
    bool is_loss = false;
};

struct Report {
    std::string title;
    std::string subtitle;  ///< One sentence: source, duration, strategy.
    Geometry geometry;     ///< Of the slices, px.
    std::vector<ReportObject> objects;
    std::vector<ReportSlice> slices;  ///< In order of time.
    std::vector<ReportCurve> curves;
    std::vector<ReportLatency> latencies;
    std::vector<ReportCount> counts;
    std::vector<std::pair<std::string, std::string>> facts;  ///< Versions and configuration.
};

/// What the page holds at most; beyond it things are thinned evenly, and the page says so.
struct ReportLimits {
    std::size_t page_bytes = 3'000'000;  ///< Kept by leaving out slices.
    std::size_t slices = 24;
    std::size_t objects = 12;        ///< With curves and outlines; the table holds 256.
    std::size_t curve_points = 700;  ///< The lowest and highest value of each interval stay.
    std::size_t model_edges = 1500;  ///< A larger model is drawn as that many dots.
    std::size_t table_rows = 256;
    std::size_t text_bytes = 2000;  ///< Of any one string.
};

/// What became of an object, in the words of the page.
struct ReportVerdict {
    bool good = false;
    std::string text;
};

/// Good: there are poses, it is not lost, and it never lied.
ReportVerdict verdict(const ReportObject& object);

/// Good: there are objects, all are good, and no loss is counted.
ReportVerdict verdict(const Report& report);

/// The page. Strings are escaped; numbers that are not finite are left out of curves and shown as
/// "–" in tables.
std::string render_report(const Report& report, const ReportLimits& limits = {});

/// Writes the page atomically.
Result<void> write_report(const std::string& path, const Report& report,
                          const ReportLimits& limits = {});

}  // namespace pursuit::ctl
