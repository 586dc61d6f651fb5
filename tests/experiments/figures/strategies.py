# SPDX-License-Identifier: Apache-2.0
"""Section 4.5, figures 14 to 16: who gets the events that may be of several objects."""

import curves
from page import Page, line_plot
from scores import failures_of, lies, lost, mean, number, objects_of
from streams import Simulated
from trackers import Pursuit

STRATEGIES = ("closest", "reject_all", "update_all", "weighted", "temporal", "spatiotemporal",
              "probabilistic")
LAYOUTS = ("overtake", "overtake_car_front", "street", "crossing")
WAYS = (("paper's constants", "paper", ""), ("gradient", "default", "gradient"),
        ("default", "default", "kalman"))


def run(settings):
    page = Page("strategies", "4.5 Occlusion strategies (figures 14–16)")
    layouts = LAYOUTS[:1] if settings.quick else LAYOUTS
    seeds = settings.seeds()
    page.text(f"Lost of all / mean speed error, % / E, px, over {len(layouts)} layouts and "
              f"{len(seeds)} seeds with clicks of 0.5 px each. The paper: spatiotemporal 5.4 % "
              "(van) and 6.5 % (car), nothing lost.")
    for label, preset, estimator in WAYS:
        trackers = [Pursuit(s, preset, estimator, s) for s in STRATEGIES]
        streams = [Simulated(layout, seed) for layout in layouts for seed in seeds]
        cases = [(s, t) for s in streams for t in trackers]
        results = settings.scores.of(cases)
        page.heading(label)
        rows = []
        for tracker in trackers:
            row = [tracker.label]
            for name in ("van", "car"):
                scores = objects_of(results, [(s, tracker) for s in streams], name)
                row += [f"{lost(scores)} of {len(scores)}",
                        number(mean(scores, "speed_error_pct"), 1), number(mean(scores, "E"))]
            row.append(lies(objects_of(results, [(s, tracker) for s in streams])))
            rows.append(row)
        page.table(["strategy", "van: lost", "speed error, %", "E, px", "car: lost",
                    "speed error, %", "E, px", "lies"], rows)
        for failure in dict.fromkeys(failures_of(results, cases)):
            page.text("A run failed: " + failure)
        shown = [(t, settings.scores.curves((streams[0], t), curves.speed_curve, "speeds"),
                  settings.scores.curves((streams[0], t), curves.error_curve, "errors"))
                 for t in trackers if "failed" not in results[(streams[0], t)]]
        page.plots(*[line_plot(f"Speed of the {name}, {label} (figure 16)",
                               [(t.label, *speeds[name]) for t, speeds, _ in shown
                                if name in speeds], "s", "px/s") for name in ("van", "car")],
                   *[line_plot(f"E of the {name}, {label}",
                               [(t.label, *errors[name]) for t, _, errors in shown
                                if name in errors], "s", "px", y_range=(0, 6))
                     for name in ("van", "car")])
    rates(settings, page, Simulated(layouts[0], seeds[0]))
    return page


def rates(settings, page, stream):
    """Figures 14 and 15: events a second near each object, and their distances."""
    tracker = Pursuit("default")
    rate = settings.scores.curves((stream, tracker), curves.event_rates, "rates")
    distances = settings.scores.curves((stream, tracker), curves.event_distances, "distances")
    page.plots(line_plot("Events near each object (figure 14)",
                         [(name, *of) for name, of in rate.items()], "s", "events/s"),
               line_plot("Distances of events to each object (figure 15)",
                         [(name, [0.2 * i + 0.1 for i in range(len(of))], of)
                          for name, of in distances.items()], "px", "share of all events"))
