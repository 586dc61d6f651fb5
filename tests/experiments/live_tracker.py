# SPDX-License-Identifier: Apache-2.0
"""The tracker as its user runs it: sensor, tracker and a viewer as processes of their own on DDS."""

import csv
import itertools
import json
import os
import sys
import time
from dataclasses import dataclass

from programs import BIN, CTL, SOURCE, Failed, digest_of_program, run

sys.path.insert(0, os.path.join(SOURCE, "tests/system"))
os.environ.setdefault("PURSUIT_BIN", BIN)
from pursuit_process import FreeDomain, Process  # noqa: E402


@dataclass(frozen=True)
class LivePursuit:
    """At real time over DDS on loopback; beside the poses the tracker's last status is kept."""
    label: str
    estimator: str
    parameters: tuple = ()  # (name, value), of each object

    def key(self):
        programs = ("pursuitctl", "pursuit-sensor", "pursuit-tracker")
        return f"live, watched {self.estimator} {self.parameters} " + " ".join(
            digest_of_program(os.path.join(BIN, name)) for name in programs)

    def track(self, files, folder):
        """Writes poses.csv, and status.json with the most of busy and lag and the mean of busy;
        returns the former's path and the event time, s."""
        domain = FreeDomain()
        dds = ["--set", f"dds.domain={domain.domain}", "--set", "dds.loopback_only=true"]
        ctl = ["--domain", domain.domain, "--loopback"]
        poses = os.path.join(folder, "poses.csv")
        processes = []

        def start(name, *arguments, ready=True):
            processes.append(Process(name, arguments, folder, ready))
            return processes[-1]

        try:
            start("pursuit-tracker", *dds)
            register = ["--transform", files.transform, "--estimator", self.estimator]
            for name, value in self.parameters:
                register += ["--set", f"{name}={value}"]
            for model in files.starts():
                run([CTL, "model", "register", model, *register, *ctl])
            viewer = start("pursuitctl", "poses", "--csv", poses, *ctl, ready=False)
            # One that stays: each that joins anew takes from the processors what it measures.
            watcher = start("pursuitctl", "status", "--watch", "--json", *ctl, ready=False)
            start("pursuit-sensor", *dds, "--set", f"recording={files.events}", "--set",
                  "wait_for_subscribers=1")
            end_us = last_event_us(files)
            deadline = time.monotonic() + end_us * 1e-6 + 20
            while last_status(watcher).get("last_t_us", 0) < end_us - 2000:
                if time.monotonic() > deadline:
                    raise Failed(f"the tracker is not at {end_us} us: {last_status(watcher)}")
                time.sleep(0.5)
            told = statuses(watcher)
            viewer.stop()
        finally:
            for process in processes:
                process.kill()
            domain.close()
        # Busy is of the last whole second of event time; lag is only there while events come.
        busy = [of for of, _ in itertools.groupby(s["busy_fraction"] for s in told) if of > 0]
        lags_us = [s["lag_us"] for s in told if s["last_t_us"] < end_us - 2000]
        with open(os.path.join(folder, "status.json"), "w") as file:
            json.dump({**told[-1], "busy_most": max(busy, default=0),
                       "busy_mean": sum(busy) / max(len(busy), 1),
                       "lag_us": max(lags_us, default=0)}, file)
        return poses, end_us * 1e-6


def statuses(watcher):
    """Of the tracker, as the watcher has told them so far; a line half written is not among them."""
    lines = watcher.out().split("\n")[:-1]
    return [status for status in (json.loads(line)["tracker"] for line in lines) if status]


def last_status(watcher):
    return (statuses(watcher) or [{}])[-1]


def last_event_us(files):
    with open(files.truth, newline="") as file:
        return max(int(row["t_us"]) for row in csv.DictReader(file))
