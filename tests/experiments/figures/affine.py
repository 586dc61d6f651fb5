# SPDX-License-Identifier: Apache-2.0
"""Section 4.3, figures 10 and 11: H, star and car under changing distance and angle."""

import statistics

import curves
from page import Page, line_plot
from scores import lost_and_error, mean, number, objects_of
from streams import Simulated
from trackers import OURS, PAPER, TRUTH, FrameBased, Pursuit

GRADIENT = Pursuit("gradient, best constants", preset="paper", parameters=(
    ("gate_px", 6), ("gradient_position_gain", 0.03), ("gradient_angle_gain_rad_px2", 5e-5),
    ("gradient_scale_gain_1_px", 2e-4), ("gradient_affine_gain_1_px2", 4e-5)))
FRAMES = FrameBased("ICP, 200 µs, gated", "icp", 200, ("--gate", 6, "--least-points", 20,
                                                       "--share", 0.5))
SCENES = ("affine_H", "affine_star", "affine_car", "affine_car_shear")
TILTED = ("perspective_H", "perspective_star", "perspective_car")


def run(settings):
    page = Page("affine", "4.3 Affine motion (figures 10–11)")
    trackers = (TRUTH, OURS, GRADIENT, PAPER, FRAMES)
    seeds = settings.seeds()
    page.text("The paper: mean D1 at most 0.64 px. D1 of those kept / lost / E.")
    rows = []
    for scene in SCENES[:1] if settings.quick else SCENES:
        streams = [Simulated(scene, s) for s in seeds]
        results = settings.scores.of([(s, t) for s in streams for t in trackers], d1=True)
        row = [scene]
        for tracker in trackers:
            scores = objects_of(results, [(s, tracker) for s in streams])
            row.append(f"{number(mean(scores, 'D1'))} / {lost_and_error(scores)}")
        rows.append(row)
    page.table(["scene"] + [t.label for t in trackers], rows)

    page.heading("Perspective of a tilted plane")
    page.text("Mean distance of the true view from the affine map that fits it best, px, and how "
              "many times that the tracker is off; medians over the seeds, and the worst.")
    rows = []
    for scene in TILTED[:1] if settings.quick else TILTED:
        row = [scene]
        for tracker in (OURS, GRADIENT):
            ratios, fits = [], []
            for seed in seeds:
                kept = settings.scores.curves((Simulated(scene, seed), tracker),
                                              curves.perspective_fit, "perspective")
                for fit_px, off_px in kept.values():
                    fits.append(fit_px)
                    ratios.append(off_px / fit_px)
            if tracker is OURS:
                row.append(number(statistics.median(fits)))
            row += [number(statistics.median(ratios)), number(max(ratios))]
        rows.append(row)
    page.table(["scene", "best fit, px", "default: median", "worst", "gradient: median", "worst"],
               rows)

    stream = Simulated("affine_H", seeds[0])
    shown = {t: settings.scores.curves((stream, t), curves.error_curve, "errors")
             for t in (OURS, GRADIENT, PAPER)}
    page.plots(line_plot("E of the H over time (figure 11)",
                         [(t.label, *shown[t]["H"]) for t in shown if "H" in shown[t]], "s", "px"),
               *[shape_over_time(settings, stream, axis) for axis in (0, 1)])
    return page


def shape_over_time(settings, stream, axis):
    series = []
    for tracker in (OURS, GRADIENT, TRUTH):
        of = settings.scores.curves((stream, tracker), curves.pose_curve, "poses")
        if "H" in of:
            series.append((tracker.label, *of["H"][axis]))
    return line_plot(("Tx", "Ty")[axis] + " of the H", series, "s", "px")
