#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""One benchmark built twice: what each case costs in both builds, run in turns.

    compare_builds.py PORTABLE NATIVE [--filter used/kalman] [--turns 5]

For example the build for any x86-64 beside one for this very processor:

    cmake --build --preset release --target tracker_bench
    cmake --preset release -B build/native -DCMAKE_CXX_FLAGS=-march=native
    cmake --build build/native --target tracker_bench
    tests/bench/compare_builds.py build/release/bench/tracker_bench build/native/bench/tracker_bench
"""

import argparse
import json
import os
import statistics
import subprocess


def ns_per_event(program, wanted, seconds):
    """Of every case with a counter per_event: its name and ns of this program's processor time."""
    done = subprocess.run([program, f"--benchmark_filter={wanted}", "--benchmark_format=json",
                           f"--benchmark_min_time={seconds}"], check=True,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return {case["name"]: case["per_event"] * 1e9
            for case in json.loads(done.stdout)["benchmarks"] if "per_event" in case}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("portable")
    parser.add_argument("native")
    parser.add_argument("--filter", default="points:120|full_affine|/objects:10$")
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=0.1, help="of each case in a turn")
    options = parser.parse_args()
    costs = {options.portable: {}, options.native: {}}
    for _ in range(options.turns):
        for program, cases in costs.items():
            for name, ns in ns_per_event(program, options.filter, options.seconds).items():
                cases.setdefault(name, []).append(ns)
    print(f"ns an event, medians of {options.turns} turns; load {os.getloadavg()[0]:.1f}")
    print(f"{'case':36} {'portable':>9} {'native':>9} {'ratio':>6}")
    for name, portable in costs[options.portable].items():
        native = costs[options.native][name]
        ratio = statistics.median(p / n for p, n in zip(portable, native))
        print(f"{name:36} {statistics.median(portable):9.1f} {statistics.median(native):9.1f}"
              f" {ratio:6.2f}")


if __name__ == "__main__":
    main()
