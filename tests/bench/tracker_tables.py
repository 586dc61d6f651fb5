#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs tracker_bench several times over, its cases in a random order, and prints the tables of
BENCHMARK.md: ns an event, the median of the repetitions.

    tests/bench/tracker_tables.py build/release/bench/tracker_bench [--repeats 5]
"""

import argparse
import json
import os
import re
import statistics
import subprocess

PLACES = ("used", "inside", "rejected")
ESTIMATORS = ("gradient", "kalman")


def measure(program, repeats, seconds, wanted):
    """Of each case its runs, each a dictionary of counters; in the order of the program."""
    listed = subprocess.run([program, "--benchmark_list_tests", f"--benchmark_filter={wanted}"],
                            check=True, stdout=subprocess.PIPE, text=True).stdout.split("\n")
    done = subprocess.run(
        [program, "--benchmark_format=json", f"--benchmark_min_time={seconds}",
         f"--benchmark_repetitions={repeats}", "--benchmark_enable_random_interleaving=true",
         f"--benchmark_filter={wanted}"],
        check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    runs = {name: [] for name in listed if name}
    for run in json.loads(done.stdout)["benchmarks"]:
        if run["run_type"] != "iteration":
            continue
        if run.get("error_occurred"):
            raise SystemExit(f"{run['name']}: {run['error_message']}")
        runs[run["run_name"]].append(run)
    return runs


def median(runs, name, counter, factor=1.0):
    if name not in runs:
        return ""
    value = factor * statistics.median(run[counter] for run in runs[name])
    return f"{value:.0f}" if value >= 100 else f"{value:.1f}"


def print_costs(runs):
    columns = [(estimator, place) for estimator in ESTIMATORS for place in PLACES]
    cases = []
    for name in runs:
        place, _, rest = name.partition("/")
        estimator, _, case = rest.partition("/")
        if place in PLACES and case not in cases:
            cases.append(case)
    if not cases:
        return
    print("| ns an event | " + " | ".join(f"{e}, {p}" for e, p in columns) + " |")
    print("|---" * (len(columns) + 1) + "|")
    for case in cases:
        cells = [median(runs, f"{place}/{estimator}/{case}", "per_event", 1e9)
                 for estimator, place in columns]
        print(f"| {re.sub('[:_]', ' ', case)} | " + " | ".join(cells) + " |")
    most = {name: statistics.median(run["allocations"] for run in of_case)
            for name, of_case in runs.items() if "allocations" in of_case[0]}
    worst = max(most, key=most.get)
    print(f"\nallocations an event: {most[worst]:.1g} at most ({worst}), "
          f"{statistics.median(most.values()):.1g} in the median case")


def print_ratios(runs):
    if not any(name.startswith("ratio/") for name in runs):
        return
    print("\n| points | kHz | scalar reading, ns | gradient | kalman | kalman, full affine "
          "| scalar / gradient | scalar / kalman |\n|---|---|---|---|---|---|---|---|")
    for name in (name for name in runs if name.startswith("ratio/scalar/")):
        counters = ("scalar_ns", "gradient_ns", "kalman_ns", "affine_ns", "scalar/gradient",
                    "scalar/kalman")
        points, rate = (part.rpartition(":")[2] for part in name.split("/")[2:])
        print(f"| {points} | {rate} | "
              + " | ".join(median(runs, name, counter) for counter in counters) + " |")
    print("\n| objects | estimator, events | one object, ns | that many, ns | many / one |\n"
          "|---|---|---|---|---|")
    for name in (name for name in runs if name.startswith("ratio/objects:")):
        _, objects, estimator, place = name.split("/")
        print(f"| {objects.partition(':')[2]} | {estimator}, {place} | "
              + " | ".join(median(runs, name, counter)
                           for counter in ("one_ns", "many_ns", "many/one")) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=0.1, help="of each case each time")
    parser.add_argument("--filter", default=".")
    options = parser.parse_args()
    before = os.getloadavg()[0]
    runs = measure(options.program, options.repeats, options.seconds, options.filter)
    print(f"medians of {options.repeats} repetitions; load before {before:.1f}, over the last "
          f"minutes {os.getloadavg()[1]:.1f} on {os.cpu_count()} processors\n")
    print_costs(runs)
    print_ratios(runs)


if __name__ == "__main__":
    main()
