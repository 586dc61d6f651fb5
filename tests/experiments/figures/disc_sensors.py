# SPDX-License-Identifier: Apache-2.0
"""The turning disc over what sensors differ in: threshold and refractory period, blur and jitter."""

from page import Page
from scores import lost, mean, median, number, objects_of, worst
from streams import Simulated
from trackers import OURS, Pursuit

BEST_GRADIENT = Pursuit("gradient, best constants", preset="paper", parameters=(
    ("gate_px", 6), ("gradient_position_gain", 0.02), ("gradient_angle_gain_rad_px2", 5e-5)))
THRESHOLDS = (0.15, 0.3, 0.6, 0.9)
REFRACTORIES_US = (1, 100, 900, 5000)
BLURS_PX = (0.5, 0.75, 1.0)
JITTERS_US = (30, 100, 200)
SPEEDS = (670, 1250, 3000)


def run(settings):
    page = Page("disc_sensors", "The disc over sensor settings")
    seeds = settings.seeds(1 if settings.quick else 2)
    page.text(f"Lost of all, mean E and worst |θ| error (bias + sigma) of the default, star and "
              f"arrow, {len(seeds)} seeds each, blur 0.5 px, jitter 20 µs.")
    for rpm in SPEEDS[:1] if settings.quick else SPEEDS:
        page.heading(f"{rpm} rpm: threshold × refractory period")
        streams = {(c, r): [Simulated(f"{shape}_{rpm}rpm", s, (
            f"sensor.threshold={c}", f"sensor.refractory_us={r}", "sensor.jitter_us=20",
            "sensor.blur_px=0.5")) for shape in ("star", "disc_arrow") for s in seeds]
            for c in THRESHOLDS for r in REFRACTORIES_US}
        results = settings.scores.of([(s, OURS) for of in streams.values() for s in of])
        rows = []
        everything = []
        for c in THRESHOLDS:
            row = [f"threshold {c}"]
            for r in REFRACTORIES_US:
                scores = objects_of(results, [(s, OURS) for s in streams[(c, r)]])
                everything += scores
                turns = [abs(s.get("theta_bias") or 0) + (s.get("theta_sigma") or 0)
                         for s in scores if not s["lost"]]
                row.append(f"{lost(scores)} / {number(mean(scores, 'E'), 3)} / "
                           f"{number(max(turns, default=float('nan')), 4)}")
            rows.append(row)
        page.table(["lost / E, px / θ, rad"] + [f"{r} µs" for r in REFRACTORIES_US], rows)
        page.text(f"Over all cells: lost {lost(everything)} of {len(everything)}, median E "
                  f"{number(median(everything, 'E'), 3)} px, worst {number(worst(everything, 'E'), 3)} px.")
    for rpm in SPEEDS[:1] if settings.quick else SPEEDS:
        page.heading(f"{rpm} rpm: blur × jitter")
        streams = {(b, j): [Simulated(f"{shape}_{rpm}rpm", s, (
            f"sensor.blur_px={b}", f"sensor.jitter_us={j}"))
            for shape in ("star", "disc_arrow") for s in seeds]
            for b in BLURS_PX for j in JITTERS_US}
        trackers = (OURS, BEST_GRADIENT)
        results = settings.scores.of([(s, t) for of in streams.values() for s in of
                                      for t in trackers])
        rows = []
        for b in BLURS_PX:
            row = [f"blur {b} px"]
            for j in JITTERS_US:
                ours, gradient = (objects_of(results, [(s, t) for s in streams[(b, j)]])
                                  for t in trackers)
                row.append(f"{lost(ours)} / {number(mean(ours, 'E'), 3)}; "
                           f"{lost(gradient)} / {number(mean(gradient, 'E'), 3)}")
            rows.append(row)
        page.table(["lost / E, px: default; gradient at its best constants"] +
                   [f"{j} µs" for j in JITTERS_US], rows)
    return page
