# SPDX-License-Identifier: Apache-2.0
"""Section 4.4, figures 12 and 13: a road with static and moving occlusions, beside frame-based
iterated closest point on the same events."""

import curves
from page import Page, line_plot, overlay
from scores import failures_of, lost_and_error, mean, number, objects_of
from streams import Simulated
from trackers import OURS, PAPER, TRUTH, FrameBased, Pursuit

GRADIENT = Pursuit("gradient", estimator="gradient")
FRAMES = (
    FrameBased("ICP, 200 µs, gated", "icp", 200, ("--gate", 3, "--least-points", 3)),
    FrameBased("ICP, 100 grey frames/s, ungated", "icp", 10_000, (), True),
    FrameBased("ICP, 100 grey frames/s, gated", "icp", 10_000, ("--gate", 6), True),
    FrameBased("ICP, 100 event frames/s, gated", "icp", 10_000, ("--gate", 6)),
)
# How long a measurement of full brightness lasts.
EXPOSURES = ("sensor.exposure_us=1000",)
SCENES = ("roadside", "overtake", "street")


def run(settings):
    page = Page("road", "4.4 Road (figures 12–13)")
    trackers = (TRUTH, OURS, GRADIENT, PAPER) + FRAMES
    scenes = SCENES[:1] if settings.quick else SCENES
    page.text("The paper: event-based D1 0.86 px and no loss. D1 of those kept / lost / E, px. The "
              "models of overtake and street carry clicks of 0.5 px.")
    rows = []
    for scene in scenes:
        streams = [Simulated(scene, s, EXPOSURES) for s in settings.seeds()]
        cases = [(s, t) for s in streams for t in trackers]
        results = settings.scores.of(cases, d1=True)
        for name in ("van",) if scene == "roadside" else ("van", "car"):
            row = [f"{scene}, {name}"]
            for tracker in trackers:
                scores = objects_of(results, [(s, tracker) for s in streams], name)
                row.append(f"{number(mean(scores, 'D1'))} / {lost_and_error(scores)}")
            rows.append(row)
        for failure in dict.fromkeys(failures_of(results, cases)):
            page.text("A run failed: " + failure)
    page.table(["object"] + [t.label for t in trackers], rows)

    stream = Simulated("roadside", settings.seeds()[0], EXPOSURES)
    files = stream.files(settings.scores.streams)
    compared = (OURS, FRAMES[0], FRAMES[2])
    for t_s in (1.2, 2.4, 3.8):
        outlines = []
        for tracker in compared:
            at = settings.scores.curves(
                (stream, tracker), lambda f, p, t=t_s: curves.outlines_at(f, p, t), f"at {t_s}")
            outlines.append((tracker.label, at.get("van", [])))
        page.plots(overlay(f"The van at {t_s} s over 20 ms of events (figure 12)", 304, 240,
                           curves.pixels_at(files, t_s), outlines))
    shown = {t: settings.scores.curves((stream, t), curves.error_curve, "errors")
             for t in compared}
    page.plots(line_plot("E of the van (figure 13)",
                         [(t.label, *shown[t]["van"]) for t in compared if "van" in shown[t]],
                         "s", "px"))
    return page
