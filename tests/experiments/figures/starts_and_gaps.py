# SPDX-License-Identifier: Apache-2.0
"""Starts that are wrong by up to 20 px or not known, and gaps of up to 90 ms in the stream."""

import statistics

from page import Page
from scores import lies, lost_and_error, objects_of
from streams import Simulated
from trackers import Pursuit

SCENES = ("star_670rpm", "disc_arrow_1250rpm", "disc_P_3000rpm", "affine_H", "affine_car",
          "overtake", "roadside", "camera_indoor", "camera_outdoor", "noise_10hz", "noise_30hz")
STARTS_PX = (3, 6, 10, 20)
GAPS_MS = (5, 20, 50, 90)


# Where nothing is said of where the object is. (appear comes into view in the midst of the stream.)
SEARCHED = tuple(f"{shape}_{rpm}rpm" for shape in ("star", "disc_arrow", "disc_P")
                 for rpm in (670, 1250, 3000)) + \
    ("affine_H", "affine_car", "overtake", "roadside", "camera_indoor", "camera_outdoor",
     "noise_10hz", "noise_30hz", "appear")


def gap_begin_s(scene):
    return 0.2 if scene.startswith(("star_", "disc_")) else 0.6


def lost_and_lies(scores):
    return lost_and_error(scores) + (f", {lies(scores)} lie" if lies(scores) else "")


def search_row(scene, scores):
    after_s = [s["t_first_pose_s"] - s["t_whole_in_view_s"] for s in scores
               if s.get("t_first_pose_s") is not None]
    return [scene, f"{len(after_s)} of {len(scores)}",
            f"{statistics.median(after_s):.2f} / {max(after_s):.2f}" if after_s else "–",
            lost_and_lies(scores)]


def search(settings, page, seeds):
    scenes = SEARCHED[1:8:3] if settings.quick else SEARCHED
    tracker = Pursuit("searched", searches=True)
    cases = {scene: [(Simulated(scene, s), tracker) for s in seeds] for scene in scenes}
    results = settings.scores.of([c for of_scene in cases.values() for c in of_scene])
    page.heading("Searches")
    page.text("Nothing is said of where the objects are. How many are found, how long after they "
              "were wholly in view it says TRACKING (median and longest; it says so confidently "
              "0.1 s later), and lost of all / E of those kept, as above.")
    page.table(["scene", "found", "after, s", "lost / E, px"],
               [search_row(scene, objects_of(results, cases[scene])) for scene in scenes])


def run(settings):
    page = Page("starts_and_gaps", "Wrong starts and gaps in the stream")
    scenes = SCENES[1:8:3] if settings.quick else SCENES
    seeds = settings.seeds(2 if settings.quick else 4)
    page.text("Lost of all / E of those kept, px, over four seeds; objects that were ever said "
              "confidently to be more than 10 px from where they were. Starts are off by this "
              "distance, in any direction, and by 0.1 rad. In a gap no event comes, of anything; E "
              "is over all of the stream, the gap and what it takes to find the object included.")
    for heading, name, values in (("Starts", "px", STARTS_PX), ("Gaps", "ms", GAPS_MS)):
        cases = {}
        for scene in scenes:
            for value in values:
                if heading == "Starts":
                    tracker = Pursuit(f"start {value} px off", start_off_px=value)
                    streams = [Simulated(scene, s) for s in seeds]
                else:
                    tracker = Pursuit("default")
                    begin_s = gap_begin_s(scene)
                    gap = ((begin_s, begin_s + value * 1e-3),)
                    streams = [Simulated(scene, s, gaps=gap) for s in seeds]
                cases[scene, value] = [(s, tracker) for s in streams]
        results = settings.scores.of([c for of_cell in cases.values() for c in of_cell])
        page.heading(heading)
        page.table(["scene"] + [f"{value} {name}" for value in values], [
            [scene] + [lost_and_lies(objects_of(results, cases[scene, value]))
                       for value in values] for scene in scenes])
    search(settings, page, seeds)
    return page
