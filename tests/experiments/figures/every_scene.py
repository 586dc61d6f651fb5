# SPDX-License-Identifier: Apache-2.0
"""Every kind of scene with one set of constants: how many objects are lost, and how far the others
are off. Beside it what a prototype reached on other draws of like scenes."""

from page import Page
from scores import lies, lost_and_error, number, objects_of, failures_of, mean
from streams import Recorded, Simulated
from trackers import OURS, PAPER, Pursuit

GRADIENT = Pursuit("gradient", estimator="gradient")

# Over the 0.5 px of the scenes themselves.
NO_CLICKS, CLICKS_1PX = ("model_noise_px=0",), ("model_noise_px=1",)

# Row, scene, settings over it, object (None: all), what the prototype's table says (lost / E px).
ROWS = (
    ("star 670 rpm", "star_670rpm", (), None, "0 / 0.08"),
    ("star 1250 rpm", "star_1250rpm", (), None, "0 / 0.11"),
    ("star 3000 rpm", "star_3000rpm", (), None, "0 / 0.165"),
    ("arrow 670 rpm", "disc_arrow_670rpm", (), None, "0 / 0.09"),
    ("arrow 1250 rpm", "disc_arrow_1250rpm", (), None, "0 / 0.12"),
    ("arrow 3000 rpm", "disc_arrow_3000rpm", (), None, "0 / 0.16"),
    ("P 670 rpm", "disc_P_670rpm", (), None, "0 / 0.09"),
    ("P 1250 rpm", "disc_P_1250rpm", (), None, "0 / 0.12"),
    ("P 3000 rpm", "disc_P_3000rpm", (), None, "0 / 0.16"),
    ("affine H", "affine_H", (), None, "0 / 0.11"),
    ("affine star", "affine_star", (), None, "0 / 0.575"),
    ("affine car", "affine_car", (), None, "0 / 0.18"),
    ("affine car, shear", "affine_car_shear", (), None, "0 / 0.21"),
    ("overtake, van, clicks 0", "overtake", NO_CLICKS, "van", "0 / 0.27"),
    ("overtake, van, clicks 0.5 px", "overtake", (), "van", "0 / 0.49"),
    ("overtake, van, clicks 1 px", "overtake", CLICKS_1PX, "van", "0 / 0.94"),
    ("overtake, car, clicks 0", "overtake", NO_CLICKS, "car", "0 / 0.21"),
    ("overtake, car, clicks 0.5 px", "overtake", (), "car", "0 / 0.45"),
    ("overtake, car, clicks 1 px", "overtake", CLICKS_1PX, "car", "1 / 0.82"),
    ("car in front, van, clicks 0.5 px", "overtake_car_front", (), "van", "–"),
    ("car in front, car, clicks 0.5 px", "overtake_car_front", (), "car", "–"),
    ("car in front, van, clicks 1 px", "overtake_car_front", CLICKS_1PX, "van", "–"),
    ("car in front, car, clicks 1 px", "overtake_car_front", CLICKS_1PX, "car", "–"),
    ("full occlusion, van", "full_occlusion", (), "van", "–"),
    ("full occlusion, car", "full_occlusion", (), "car", "2 / 0.68"),
    ("roadside", "roadside", (), None, "0 / 0.53"),
    ("street, van", "street", (), "van", "–"),
    ("street, car", "street", (), "car", "–"),
    ("crossing, van", "crossing", (), "van", "–"),
    ("crossing, car", "crossing", (), "car", "–"),
    ("camera indoors", "camera_indoor", (), None, "0 / 0.17"),
    ("camera outdoors", "camera_outdoor", (), None, "1 / 0.27"),
    ("noise 10 Hz", "noise_10hz", (), None, "0 / 0.15"),
    ("noise 30 Hz", "noise_30hz", (), None, "0 / 0.29"),
    ("noise 100 Hz", "noise_100hz", (), None, "0 / 0.27"),
    ("appear, search", "appear", (), None, "0 / 0.28"),
)

# Among noise, Hz a pixel: a slow car that a van overtakes or hides for a while, and what others
# that nobody follows pass by.
IN_NOISE = (("overtake", "car"), ("overtake_car_front", "car"), ("street", "car"),
            ("full_occlusion", "car"), ("roadside", None), ("camera_indoor", None),
            ("camera_outdoor", None))
NOISES_HZ = (4, 8)

# Scenes in which an object ends at a time, s: it has to be said that it is lost.
ENDS = (("star taken away", "taken_away", 1.5), ("another in its place", "replaced", 1.0))

RECORDED = ("disc_star_670rpm", "disc_arrow_1250rpm", "disc_P_3000rpm_blur", "affine_H",
            "affine_car_shear", "overtake", "full_occlusion", "roadside", "camera_indoor",
            "camera_outdoor", "appear", "noise_10hz", "noise_30hz")


def run(settings):
    page = Page("every_scene", "Every scene with one set of constants")
    trackers = (OURS, GRADIENT, PAPER)
    seeds = settings.seeds()
    rows = ROWS[::5] if settings.quick else ROWS
    streams = {row[:3]: [Simulated(row[1], s, row[2]) for s in seeds] for row in rows}
    cases = [(s, t) for of_row in streams.values() for s in of_row for t in trackers]
    results = settings.scores.of(cases)

    page.text(f"Lost of all / mean E, px, of those kept, over {len(seeds)} seeds each that nothing "
              "was tuned on; in the last columns, of the default: objects that were ever said "
              "confidently to be more than 10 px from where they were, and the speed error. The "
              "prototype's figures are from other draws of like scenes.")
    table = []
    totals = {t: [] for t in trackers}
    liars = 0
    for row in rows:
        line = [row[0], row[4]]
        for tracker in trackers:
            of_row = objects_of(results, [(s, tracker) for s in streams[row[:3]]], row[3])
            totals[tracker] += of_row
            line.append(lost_and_error(of_row))
        ours = objects_of(results, [(s, OURS) for s in streams[row[:3]]], row[3])
        liars += lies(ours)
        line += [lies(ours), number(mean(ours, "speed_error_pct"), 1)]
        table.append(line)
    table.append(["all", "4 of 206"] + [lost_and_error(totals[t]) for t in trackers] + [liars, ""])
    page.table(["scene", "prototype"] + [t.label for t in trackers] + ["lies", "speed error, %"],
               table)
    for failure in dict.fromkeys(failures_of(results, cases)):
        page.text("A run failed: " + failure)

    in_noise(settings, page, trackers, seeds)
    ends(settings, page, seeds)
    recorded(settings, page, trackers)
    return page


def in_noise(settings, page, trackers, seeds):
    page.heading("Road and camera, in noise")
    page.text("As above; of two objects the car alone.")
    table = []
    for scene, name in IN_NOISE[::6] if settings.quick else IN_NOISE:
        for noise_hz in NOISES_HZ:
            streams = [Simulated(scene, s, (f"sensor.noise_hz={noise_hz}",)) for s in seeds]
            results = settings.scores.of([(s, t) for s in streams for t in trackers])
            of_row = [objects_of(results, [(s, t) for s in streams], name) for t in trackers]
            table.append([f"{scene}, {noise_hz} Hz"] + [lost_and_error(o) for o in of_row] +
                         [lies(of_row[0]), number(mean(of_row[0], "speed_error_pct"), 1)])
    page.table(["scene"] + [t.label for t in trackers] + ["lies", "speed error, %"], table)


def ends(settings, page, seeds):
    page.heading("What cannot be tracked")
    page.text("When the object is taken away, or another is put in its place: after how long the "
              "default says LOST, s (median; never counts as missed), and how often it lies.")
    table = []
    for label, scene, end_s in ENDS:
        cases = [(Simulated(scene, s), OURS) for s in seeds]
        results = settings.scores.of(cases)
        delays = sorted(s["t_first_lost_s"] - end_s for s in objects_of(results, cases)
                        if s.get("t_first_lost_s") is not None and s["t_first_lost_s"] >= end_s)
        early = sum((s.get("t_first_lost_s") or 1e9) < end_s for s in objects_of(results, cases))
        table.append([label, f"{sum(d <= 0.1 for d in delays)} of {len(cases)}",
                      number(delays[len(delays) // 2]) if delays else "–",
                      number(delays[-1]) if delays else "–",
                      len(cases) - len(delays) - early, early, lies(objects_of(results, cases))])
    cases = [(Simulated("noise_300hz", s), OURS) for s in seeds]
    results = settings.scores.of(cases)
    scores = objects_of(results, cases)
    table.append(["noise 300 Hz", f"{sum((s.get('t_first_lost_s') or 9) <= 0.1 for s in scores)} "
                  f"of {len(cases)}", number(mean([{**s, 'lost': False} for s in scores],
                                                  "t_first_lost_s")), "–",
                  sum(s.get("t_first_lost_s") is None for s in scores), "–", lies(scores)])
    page.table(["", "LOST within 0.1 s", "median, s", "longest, s", "never", "too early", "lies"],
               table)


def recorded(settings, page, trackers):
    names = RECORDED[::4] if settings.quick else RECORDED
    cases = [(Recorded(n), t) for n in names for t in trackers]
    results = settings.scores.of(cases)
    page.heading("Streams of another simulator")
    page.text("E, px, or LOST; then whether the default ever lies, and its speed error, %.")
    table = []
    for name in names:
        objects = results[(Recorded(name), OURS)]["objects"]
        for label in objects:
            line = [name + (f", {label}" if len(objects) > 1 else "")]
            for tracker in trackers:
                score = results[(Recorded(name), tracker)]["objects"].get(label)
                if score is None:
                    line.append("failed")
                elif score["lost"]:
                    line.append("LOST")
                else:
                    line.append(number(score["E"]))
            ours = objects[label]
            table.append(line + ["yes" if (ours.get("lies") or 0) > 0 else "no",
                                 number(ours.get("speed_error_pct"), 1)])
    page.table(["stream"] + [t.label for t in trackers] + ["lies", "speed error, %"], table)
