# SPDX-License-Identifier: Apache-2.0
"""Section 4.1, figures 5 to 8: a star on a turning disc; events one by one against frames."""

import curves
from page import Page, line_plot
from scores import failures_of, lost_and_error, mean, number, objects_of
from streams import Simulated
from trackers import OURS, PAPER, TRUTH, FrameBased, Pursuit

GRADIENT = Pursuit("gradient, paper's η for the disc", preset="paper", parameters=(
    ("gate_px", 6), ("gradient_angle_gain_rad_px2", 1e-4)))
BEST_GRADIENT = Pursuit("gradient, best constants", preset="paper", parameters=(
    ("gate_px", 6), ("gradient_position_gain", 0.02), ("gradient_angle_gain_rad_px2", 5e-5)))
FRAMES = (
    FrameBased("rigid SVD, 50 µs", "procrustes", 50),
    FrameBased("rigid SVD, 50 µs, gated", "procrustes", 50, ("--gate", 6)),
    FrameBased("rigid SVD, 50 µs, gated, damped", "procrustes", 50, ("--gate", 6, "--share", 0.2)),
    FrameBased("ICP, 200 µs", "icp", 200),
    FrameBased("ICP, 200 µs, gated", "icp", 200, ("--gate", 6)),
    FrameBased("ICP, 200 µs, gated, damped", "icp", 200, ("--gate", 6, "--least-points", 20,
                                                 "--share", 0.5)),
)
DURATIONS_S = {670: 2, 1250: 1, 3000: 0.5}


def bias_and_sigma(scores, axis, digits):
    return f"{number(mean(scores, axis + '_bias'), digits)} / " \
           f"{number(mean(scores, axis + '_sigma'), digits)}"


def run(settings):
    page = Page("rotating_star", "4.1 Rotating star (figures 5–8)")
    speeds = (670,) if settings.quick else (670, 1250, 3000)
    trackers = (TRUTH, OURS, GRADIENT, BEST_GRADIENT, PAPER) + FRAMES
    page.text("D1: mean distance of events within 6 px to the nearest model point, over windows of "
              "200 µs. E: rms distance of the model's points from where they truly are. Bias / "
              "sigma against the true pose. Means over those not lost.")
    for rpm in speeds:
        streams = [Simulated(f"star_{rpm}rpm", s) for s in settings.seeds()]
        cases = [(s, t) for s in streams for t in trackers]
        results = settings.scores.of(cases, d1=True)
        page.heading(f"{rpm} rpm, {len(streams)} seeds")
        rows = []
        if rpm == 670:
            rows.append(["the paper", "0.86", "–", "−0.11 / 0.45", "−0.19 / 0.54",
                         "−0.020 / 0.023", "–"])
        for tracker in trackers:
            of_tracker = [(s, tracker) for s in streams]
            scores = objects_of(results, of_tracker)
            share = sum(results[c].get("wall_s", 0) for c in of_tracker) / (
                len(streams) * DURATIONS_S[rpm])
            rows.append([tracker.label, number(mean(scores, "D1")), lost_and_error(scores),
                         bias_and_sigma(scores, "Tx", 2), bias_and_sigma(scores, "Ty", 2),
                         bias_and_sigma(scores, "theta", 3),
                         "–" if tracker is TRUTH else number(share)])
        page.table(["method", "D1, px", "lost / E, px", "Tx, px", "Ty, px", "θ, rad",
                    "busy / event time"], rows)
        for failure in dict.fromkeys(failures_of(results, cases)):
            page.text("A run failed: " + failure)
        first = streams[0]
        compared = (OURS, GRADIENT, FRAMES[2], FRAMES[5])
        of = {t: settings.scores.curves((first, t), curves.pose_curve, "poses") for t in compared}
        truth = settings.scores.curves((first, TRUTH), curves.pose_curve, "poses")
        window = slice(100, 160)
        page.plots(*[line_plot(f"{what} at {rpm} rpm (figures 6–8)",
                               [(t.label, of[t]["star"][i][0][window], of[t]["star"][i][1][window])
                                for t in compared if "star" in of[t]] +
                               [("truth", truth["star"][i][0][window], truth["star"][i][1][window])],
                               "s", unit)
                     for i, (what, unit) in enumerate((("Tx", "px"), ("Ty", "px"), ("θ", "rad")))])
    pull_in(settings, page)
    return page


def pull_in(settings, page):
    """Figure 5: from a start that is wrong."""
    page.heading("Pull-in from a wrong start (figure 5)")
    trackers = (OURS, GRADIENT, PAPER, FRAMES[4])
    rows = []
    for off_px in (3, 6, 10, 20):
        streams = [Simulated("star_670rpm", s, (f"start_error_px={off_px}", "start_error_rad=0.1"))
                   for s in settings.seeds()]
        results = settings.scores.of([(s, t) for s in streams for t in trackers])
        rows.append([f"{off_px} px"] + [
            lost_and_error(objects_of(results, [(s, t) for s in streams])) for t in trackers])
    page.text("Starts off by normal errors of this sigma in x and y and 0.1 rad: lost / E, px. A "
              "star that was off by more than a fifth of a half turn may come to rest on another arm.")
    page.table(["sigma of the start"] + [t.label for t in trackers], rows)
    stream = Simulated("star_670rpm", settings.seeds()[0],
                       ("start_error_px=6", "start_error_rad=0.1"))
    shown = {t: settings.scores.curves((stream, t), curves.error_curve, "errors") for t in trackers}
    page.plots(line_plot("E after a wrong start",
                         [(t.label, shown[t]["star"][0][:60], shown[t]["star"][1][:60])
                          for t in trackers], "s", "E, px"))
