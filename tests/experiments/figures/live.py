# SPDX-License-Identifier: Apache-2.0
"""Section 4.1 at real time: the turning star through sensor, DDS and tracker, as it is used."""

from figures.rotating_star import BEST_GRADIENT
from live_tracker import LivePursuit
from page import Page
from scores import failures_of, lost_and_error, number, objects_of
from streams import Simulated


def run(settings):
    page = Page("live", "4.1 Live, at real time through DDS")
    seeds = settings.seeds(1 if settings.quick else 4)
    duration_s = 3  # busy is told of whole seconds
    page.text(f"Sensor, tracker and a viewer are processes of their own on loopback, {len(seeds)} "
              f"streams of {duration_s} s each; the numbers are the worst of them. Busy: processing "
              "time over event time, in the mean and of the worst of the seconds that the "
              "status told (whatever else the machine did then is in it). Lag: how far the tracker was behind the sensor's clock, told "
              "every second. Late: from the instant at which a pose's packet was to be "
              "sent to the pose's publication; a packet is closed after 1 ms.")
    settings.scores.jobs = 1
    trackers = (LivePursuit("default", "kalman"),
                LivePursuit(BEST_GRADIENT.label, "gradient", BEST_GRADIENT.parameters))
    rows = []
    for rpm in (1250, 3000):
        for tracker in trackers:
            cases = [(Simulated(f"star_{rpm}rpm", s, (f"duration_s={duration_s}",)), tracker)
                     for s in seeds]
            results = settings.scores.of(cases)
            for failure in dict.fromkeys(failures_of(results, cases)):
                page.text("A run failed: " + failure)
            status = [results[c]["status"] for c in cases if "status" in results[c]]
            if not status:
                continue

            def most(value):
                return max(value(s) for s in status)

            rows.append([f"{rpm} rpm, {tracker.label}", lost_and_error(objects_of(results, cases)),
                         number(most(lambda s: s["busy_mean"])),
                         number(most(lambda s: s["busy_most"])),
                         number(most(lambda s: s["lag_us"] * 1e-3), 1),
                         number(most(lambda s: s["latency"]["p50_us"] * 1e-3), 1),
                         number(most(lambda s: s["latency"]["p99_us"] * 1e-3), 1),
                         number(most(lambda s: s["latency"]["max_us"] * 1e-3), 1),
                         most(lambda s: s["packets_missed"]), most(lambda s: s["events_dropped"])])
    page.table(["", "lost / E, px", "busy", "worst second", "lag, ms", "late, ms: median",
                "99 %", "most", "packets missed", "events dropped"], rows)
    return page
