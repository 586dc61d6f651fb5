# SPDX-License-Identifier: Apache-2.0
"""Section 4.6, figures 17 and 18: a hand-held camera, indoors and beside a road."""

import curves
from page import Page, line_plot
from scores import failures_of, lies, lost, mean, number, objects_of
from streams import Simulated
from trackers import OURS, PAPER, TRUTH, Pursuit

GRADIENT = Pursuit("gradient", estimator="gradient")
PLANES = Pursuit("gradient, spatiotemporal", estimator="gradient", strategy="spatiotemporal")
PAPER_PLANES = Pursuit("paper, spatiotemporal", preset="paper", strategy="spatiotemporal")
SCENES = (("camera_indoor", "star", "≤ 6 %"), ("camera_outdoor", "car", "≤ 15 %"))


def run(settings):
    page = Page("moving_camera", "4.6 Moving camera (figures 17–18)")
    trackers = (OURS, PLANES, GRADIENT, PAPER_PLANES, PAPER)
    streams = {scene: [Simulated(scene, s) for s in settings.seeds()] for scene, _, _ in SCENES}
    cases = [(s, t) for of in streams.values() for s in of for t in trackers]
    results = settings.scores.of(cases)
    page.text("Of those kept: mean speed error, E; and how many were lost, or ever said to be "
              "where they were not.")
    for scene, name, wanted in SCENES:
        page.heading(f"{scene} ({wanted} in the paper)")
        page.table(["tracker", "lost", "speed error, %", "E, px", "lies"],
                   [[t.label, f"{lost(scores)} of {len(scores)}",
                     number(mean(scores, "speed_error_pct"), 1), number(mean(scores, "E")),
                     lies(scores)]
                    for t in trackers
                    for scores in [objects_of(results, [(s, t) for s in streams[scene]])]])
        first = streams[scene][0]
        shown = {t: settings.scores.curves((first, t), curves.event_distances, "distances")
                 for t in (OURS, TRUTH, PAPER)}
        speeds = {t: settings.scores.curves((first, t), curves.speed_curve, "speeds")
                  for t in (OURS, TRUTH, PAPER)}
        page.plots(
            line_plot("Distances of all events to the shape (figures 17, 18)",
                      [(t.label, [0.2 * i + 0.1 for i in range(len(of[name]))], of[name])
                       for t, of in shown.items() if name in of], "px", "share of events"),
            line_plot("Speed", [(t.label, *of[name]) for t, of in speeds.items() if name in of],
                      "s", "px/s"))
    for failure in dict.fromkeys(failures_of(results, cases)):
        page.text("A run failed: " + failure)
    return page
