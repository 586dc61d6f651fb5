# SPDX-License-Identifier: Apache-2.0
"""The tracker as its user runs it: sensor, tracker and a viewer as processes of their own on DDS."""

import csv
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
        return f"live, busy in the mean {self.estimator} {self.parameters} " + " ".join(
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
            start("pursuit-sensor", *dds, "--set", f"recording={files.events}", "--set",
                  "wait_for_subscribers=1")
            end_us = last_event_us(files)
            deadline = time.monotonic() + end_us * 1e-6 + 20
            lag_us = 0
            busy = []  # of seconds
            while True:
                time.sleep(0.5)
                status = json.loads(run([CTL, "status", "--json", *ctl])[0])["tracker"]
                # Of a second of event time; the same until the next is over.
                if status["busy_fraction"] > 0 and status["busy_fraction"] != (busy or [0])[-1]:
                    busy.append(status["busy_fraction"])
                if status["last_t_us"] < end_us - 2000:
                    lag_us = max(lag_us, status["lag_us"])
                if status["last_t_us"] >= end_us - 2000:
                    break
                if time.monotonic() > deadline:
                    raise Failed(f"the tracker is at {status['last_t_us']} of {end_us} us")
            viewer.stop()
        finally:
            for process in processes:
                process.kill()
            domain.close()
        with open(os.path.join(folder, "status.json"), "w") as file:
            json.dump({**status, "busy_most": max(busy, default=0),
                       "busy_mean": sum(busy) / max(len(busy), 1),
                       "lag_us": lag_us}, file)
        return poses, end_us * 1e-6


def last_event_us(files):
    with open(files.truth, newline="") as file:
        return max(int(row["t_us"]) for row in csv.DictReader(file))
