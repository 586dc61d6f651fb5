#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The whole pipeline through real DDS: pursuit-sensor, pursuit-tracker and a process that receives
the poses, on loopback. Two objects, a fifth of the events on them, a synthetic DAT recording.

    cmake --build --preset release --target pipeline_bench
    tests/bench/pipeline/pipeline_bench.py rate       # events a second without loss
    tests/bench/pipeline/pipeline_bench.py latency    # from an event's instant to its pose
    tests/bench/pipeline/pipeline_bench.py check      # a second at 1 M events/s: nothing is lost

Measured best on a machine that does nothing else; the tables say what else it did.
"""

import argparse
import os
import statistics
import tempfile

from latency import (every_event_ns, newest_event_ns, percentile, settled, stages_ns, start_up_ns,
                     tracking_errors_px)
from pipeline_run import Pipeline, Stream, bare_hop_ns, lost_events

# A packet is closed by so many events (pursuit-sensor's default) if not by its time.
PACKET_EVENTS = 4096

# A pose that comes later than this after its time at the end of a stream: the events have piled up.
BEHIND_NS = 100e6


def us(ns):
    return f"{ns / 1000:.0f}"


def conditions(results):
    others = statistics.median(result["others"] for result in results)
    return (f"{os.cpu_count()} processors, of which other work took {others:.2f} meanwhile; "
            f"load {os.getloadavg()[0]:.1f}")


class Bench:
    def __init__(self, folder, options):
        self.folder, self.options = folder, options

    def pass_of(self, stream, estimator, packets=False):
        with Pipeline(self.folder, packets) as pipeline:
            return pipeline.run(
                stream, estimator,
                {"packet_us": self.options.packet_us, "packet_events": PACKET_EVENTS},
                {"pose_rate_hz": self.options.pose_rate_hz})

    # Events a second.

    def sustains(self, stream, estimator):
        """A row of the table for one pass, and whether nothing was lost and nothing piled up."""
        result = self.pass_of(stream, estimator)
        poses = result["poses"]
        last = poses[-max(1, len(poses) // 10):]
        behind_ns = statistics.median(pose["received_ns"] - pose["host_time_ns"] for pose in last)
        errors, not_tracking = tracking_errors_px(poses, stream.truth())
        lost = lost_events(result)
        good = lost == 0 and behind_ns < BEHIND_NS
        print(f"| {estimator} | {stream.rate_hz / 1e6:.2f} | {lost} | {behind_ns / 1e6:.1f} "
              f"| {result['tracker']['queue_packets_max']} "
              f"| {result['sensor_cpu_s'] / stream.count * 1e9:.0f} "
              f"| {result['tracker_cpu_s'] / stream.count * 1e9:.0f} "
              f"| {statistics.median(errors):.2f} | {not_tracking} | {result['others']:.2f} "
              f"| {'yes' if good else 'no'} |", flush=True)
        return good

    def rate(self):
        print("| estimator | M events/s | lost | behind at the end, ms | most packets waiting "
              "| sensor, CPU ns/event | tracker, CPU ns/event | median error, px "
              "| poses not TRACKING | other work, processors | sustained |")
        print("|---|---|---|---|---|---|---|---|---|---|---|")
        best = {}
        for estimator in self.options.estimators:
            best[estimator] = self.highest_rate(estimator)
        for estimator, rate_hz in best.items():
            print(f"\n{estimator}: {rate_hz / 1e6:.2f} M events/s sustained, 0 lost, in each of "
                  f"{self.options.repeats} passes")
        return all(rate_hz > 0 for rate_hz in best.values())

    def highest_rate(self, estimator):
        """The highest of a geometric ladder about the target that every repeated pass sustains."""
        step = self.options.step
        rate_hz = self.options.target
        good = self.passes(rate_hz, estimator)
        while good:
            if not self.passes(rate_hz * step, estimator):
                return rate_hz
            rate_hz *= step
        while rate_hz > 50e3:
            rate_hz /= step
            if self.passes(rate_hz, estimator):
                return rate_hz
        return 0

    def passes(self, rate_hz, estimator):
        stream = Stream(self.folder, rate_hz, self.options.seconds)
        return all(self.sustains(stream, estimator) for _ in range(self.options.repeats))

    # Latency.

    def latency(self):
        rate_hz = self.options.latency_rate
        stream = Stream(self.folder, rate_hz, self.options.latency_seconds)
        events = min(PACKET_EVENTS, round(rate_hz * self.options.packet_us * 1e-6))
        period_us = round(events / rate_hz * 1e6)
        hops, results, split = [], {}, {}
        for _ in range(self.options.repeats):
            for estimator in self.options.estimators:
                hops += bare_hop_ns(self.folder, events, period_us, 2000)
                results.setdefault(estimator, []).append(self.pass_of(stream, estimator))
                split.setdefault(estimator, []).append(self.pass_of(stream, estimator, packets=True))
        hops += bare_hop_ns(self.folder, events, period_us, 2000)
        hop_ns = percentile(hops, 0.5)
        print(f"{rate_hz / 1e6:.2f} M events/s, packets of {events} events every {period_us} us, "
              f"{conditions(sum(results.values(), []))}\n")
        print("us | median | p99 | bound of the median | bound of p99\n---|---|---|---|---")
        print(f"bare hop of a packet | {us(hop_ns)} | {us(percentile(hops, 0.99))} | |")
        median_bound_ns = period_us * 1000 + 3 * hop_ns
        for estimator, passes in results.items():
            for name, latencies in (("newest event of each pose", newest_event_ns),
                                    ("every event to the first pose that knows it",
                                     every_event_ns)):
                values = [latencies(settled(each["poses"])) for each in passes]
                print(f"{estimator}: {name} "
                      f"| {us(statistics.median(percentile(v, 0.5) for v in values))} "
                      f"| {us(statistics.median(percentile(v, 0.99) for v in values))} "
                      f"| {us(median_bound_ns)} | {period_us + 1000}")
            start_ups = [start_up_ns(each["poses"]) for each in passes]
            print(f"{estimator}: the most in the first second | {us(statistics.median(start_ups))} "
                  "| | |")
        print(f"\nmedians of {self.options.repeats} passes; lost: "
              f"{sum(lost_events(each) for each in sum(results.values(), []))}")
        self.print_stages(split)
        return True

    def print_stages(self, split):
        print("\nBy stage, of the newest event of each pose, with a fourth process that receives "
              "the packets too:\n\nus | median | p99\n---|---|---")
        for estimator, passes in split.items():
            stages = {}
            for each in passes:
                found = stages_ns(settled(each["poses"]), each["packets"],
                                  self.options.packet_us, PACKET_EVENTS)
                for name, values in found.items():
                    stages.setdefault(name, []).extend(values)
                stages.setdefault("all of it", []).extend(newest_event_ns(settled(each["poses"])))
            for name, values in stages.items():
                print(f"{estimator}: {name} | {us(percentile(values, 0.5))} "
                      f"| {us(percentile(values, 0.99))}")

    def check(self):
        stream = Stream(self.folder, 1e6, 1)
        result = self.pass_of(stream, self.options.estimators[0])
        errors, not_tracking = tracking_errors_px(result["poses"], stream.truth())
        lost = lost_events(result)
        print(f"{stream.count} events, {lost} lost; {len(errors)} poses, {not_tracking} not "
              f"TRACKING, median error {statistics.median(errors):.2f} px")
        return lost == 0 and not_tracking == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["rate", "latency", "check"])
    parser.add_argument("--estimators", nargs="+", default=["kalman", "gradient"])
    parser.add_argument("--repeats", type=int, default=3, help="passes that must agree")
    parser.add_argument("--target", type=float, default=10e6, help="events/s to begin the search at")
    parser.add_argument("--step", type=float, default=1.25, help="from one rate to the next")
    parser.add_argument("--seconds", type=float, default=3, help="of each stream of the search")
    parser.add_argument("--latency-rate", type=float, default=1e6, help="events/s")
    parser.add_argument("--latency-seconds", type=float, default=8)
    parser.add_argument("--packet-us", type=int, default=1000, help="a packet's time")
    parser.add_argument("--pose-rate-hz", type=float, default=1000, help="of each object")
    options = parser.parse_args()
    if options.step <= 1:
        parser.error("--step: a ladder needs steps above 1")
    with tempfile.TemporaryDirectory(prefix="pursuit-bench-") as folder:
        good = getattr(Bench(folder, options), options.what)()
    raise SystemExit(0 if good else 1)


if __name__ == "__main__":
    main()
