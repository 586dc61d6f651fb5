# SPDX-License-Identifier: Apache-2.0
"""Section 4.2, figure 9: how many points a model needs, and what each costs."""

from page import Page, line_plot
from scores import lost, mean, number, objects_of
from streams import Simulated
from trackers import OURS, Pursuit

GRADIENT = Pursuit("gradient", preset="paper", parameters=(
    ("gate_px", 6), ("gradient_position_gain", 0.02), ("gradient_angle_gain_rad_px2", 5e-5)))
COUNTS = (10, 15, 20, 30, 40, 60, 90, 150, 300, 600, 1200)


def run(settings):
    page = Page("points_and_rate", "4.2 Points of the model against rate and error (figure 9)")
    counts = COUNTS[::4] if settings.quick else COUNTS
    trackers = (OURS, GRADIENT)
    seeds = settings.seeds(2 if settings.quick else 4)
    page.text("The star at 670 rpm; every corner is a point of each model. Rate: events of the "
              "stream over the time that tracking took, offline, on one core of this machine, "
              "which others used at the same time. E is over the points of the model itself.")
    rows = []
    curves = {t: ([], []) for t in trackers}
    rates = {t: ([], []) for t in trackers}
    for count in counts:
        streams = [Simulated("star_670rpm", s, (f"layer[0].model_points={count}",)) for s in seeds]
        results = settings.scores.of([(s, t) for s in streams for t in trackers], d1=True)
        row = []
        for tracker in trackers:
            cases = [(s, tracker) for s in streams]
            scores = objects_of(results, cases)
            wall_s = sum(results[c].get("wall_s", 0) for c in cases)
            events = sum(results[c].get("events", 0) for c in cases)
            rate = events / wall_s / 1e3 if wall_s > 0 else float("nan")
            row += [number(rate, 0), number(mean(scores, "D1")), number(mean(scores, "E"), 3),
                    lost(scores)]
            curves[tracker][0].append(count)
            curves[tracker][1].append(mean(scores, "E"))
            rates[tracker][0].append(count)
            rates[tracker][1].append(rate)
        rows.append([count] + row)
    page.table(["points"] + [f"{t.label}: {w}" for t in trackers
                             for w in ("kHz", "D1, px", "E, px", "lost")], rows)
    page.plots(line_plot("Error against points", [(t.label, *curves[t]) for t in trackers],
                         "points", "E, px", dots=True),
               line_plot("Rate against points", [(t.label, *rates[t]) for t in trackers],
                         "points", "kHz", dots=True))
    return page
