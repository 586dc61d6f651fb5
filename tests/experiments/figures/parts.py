# SPDX-License-Identifier: Apache-2.0
"""What each part of the filter is good for: the same scenes with one part after another left out."""

from page import Page
from scores import failures_of, lies, lost_and_error, mean, number, objects_of
from streams import Simulated
from trackers import OURS, Pursuit

# The switch, and what is left out with it at 0 (`pursuitctl parameters`).
PARTS = (
    ("uses_event_clock", "event clock"),
    ("remembers_pace", "pace"),
    ("uses_leads", "leads, and all that goes with them"),
    ("holds_leads", "physics of the leads"),
    ("learns_trail", "trail"),
    ("tells_contrast", "contrast of edges"),
    ("tells_polarity", "polarity"),
    ("remembers_levels", "levels of pixels"),
    ("hears_silence", "quiet facings"),
    ("learns_steadiness", "steadiness"),
    ("measures_clutter", "measured clutter"),
    ("adapts_noise", "adaptive measurement noise"),
    ("watches_noise", "look-out among noise"),
    ("learns_offsets", "offsets of the contour"),
    ("learns_bend", "bend of a view in perspective"),
    ("tells_occlusion", "who hides whom"),
    ("checks_pose", "checks of the pose"),
)

# Column, scene, settings over it.
SCENES = (
    ("disc, 3000 rpm", "disc_arrow_3000rpm", ()),
    ("perspective", "perspective_car", ()),
    ("overtake, clicks 1 px", "overtake", ("model_noise_px=1",)),
    ("full occlusion", "full_occlusion", ()),
    ("roadside", "roadside", ()),
    ("camera indoors", "camera_indoor", ()),
    ("camera outdoors", "camera_outdoor", ()),
    ("noise 30 Hz", "noise_30hz", ()),
    ("noise 100 Hz", "noise_100hz", ()),
)


def run(settings):
    page = Page("parts", "What each part is good for")
    seeds = settings.seeds(2 if settings.quick else 4)
    scenes = SCENES[::4] if settings.quick else SCENES
    without = [(label, Pursuit(f"without {label}", parameters=((switch, 0),)))
               for switch, label in PARTS]
    every = tuple((switch, 0) for switch, _ in PARTS)
    trackers = [("–", OURS), *without, ("all of these", Pursuit("plain", parameters=every))]
    streams = [[Simulated(scene, seed, changed) for seed in seeds] for _, scene, changed in scenes]
    cases = [(s, t) for of_scene in streams for s in of_scene for _, t in trackers]
    results = settings.scores.of(cases)

    page.text(f"Lost of all / mean E, px, of those kept, over {len(seeds)} seeds each; in the last "
              "columns over all scenes: objects lost, those that ever lied, the mean speed error. "
              "In perspective the transform is the full affine.")
    table = []
    for label, tracker in trackers:
        line, of_all = [label], []
        for of_scene in streams:
            of_cell = objects_of(results, [(s, tracker) for s in of_scene])
            of_all += of_cell
            line.append(lost_and_error(of_cell))
        line += [lost_and_error(of_all), lies(of_all), number(mean(of_all, "speed_error_pct"), 1)]
        table.append(line)
    page.table(["without", *(name for name, _, _ in scenes), "all", "lies", "speed error, %"],
               table)
    for failure in dict.fromkeys(failures_of(results, cases)):
        page.text("A run failed: " + failure)
    return page
