#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""kill -9 and restart of the tracker: what it then tells of an object that it had lost, and in a
stream that is not the one it was killed in."""

import csv
import json
import os
import time
import unittest

from pursuit_process import SystemTest


class Resume(SystemTest):
    def begin(self, scene):
        """A tracker with the scene's models registered, and the scene's events."""
        self.ctl("simulate", scene, "--seed", 3, "--events", self.path("events.dat"), "--truth",
                 self.path("truth.csv"), "--models", self.path("models"), dds=False, timeout=120)
        self.store = self.path("tracker.store")
        self.tracker = self.service("tracker", store=self.store)
        with open(self.path("models/start.csv"), newline="") as file:
            for row in csv.DictReader(file):
                name = row["object"]
                self.ctl("model", "register", self.path(f"models/model_{name}.csv") +
                         f"@{row['x_px']},{row['y_px']},{row['theta_rad']}")
        self.viewer = self.start("pursuitctl", *self.ctl_arguments("poses", "--json", "--for", 60),
                                 ready=False)

    def sensor(self, **fields):
        return self.service("sensor", recording=self.path("events.dat"), exit_at_end=False,
                            wait_for_subscribers=1, **fields)

    def poses(self, model, seen=0):
        """What the viewer was told of a model, after what it had said when it was asked last."""
        lines = self.viewer.out()[seen:].splitlines(keepends=True)
        poses = [json.loads(line) for line in lines if line.endswith("\n")]
        return [pose for pose in poses if pose["model"] == model]

    def restart_tracker(self):
        """Gives how much the viewer had said before."""
        self.tracker.kill()
        seen = self.viewer.out().rfind("\n") + 1  # not within a line
        self.tracker = self.service("tracker", store=self.store)
        return seen

    def test_of_a_lost_object_does_not_tell_it_to_be_tracked(self):
        self.begin("taken_away")
        self.sensor(rate=0.5)
        # It is taken away 1.5 s after the beginning, for good.
        self.eventually(lambda: any(p["t_us"] > 1_500_000 and p["state"] == "LOST"
                                    for p in self.poses("star")), what="the star is lost")
        self.eventually(lambda: self.poses("star")[-1]["t_us"] > 1_850_000, what="it is stored")
        seen = self.restart_tracker()
        self.eventually(lambda: [p for p in self.poses("star", seen) if p["t_us"] > 2_400_000],
                        what="the end of the scene")
        told = self.poses("star", seen)
        print(f"{len(told)} poses after the restart, from {told[0]['t_us']} us on")
        self.assertEqual({pose["state"] for pose in told}, {"LOST"})

    def test_writes_nothing_to_the_store_before_the_first_packet(self):
        self.begin("overtake")
        sensor = self.sensor()
        self.eventually(lambda: self.poses("van") and self.poses("van")[-1]["t_us"] > 500_000,
                        what="event time 0.5 s")
        sensor.kill()
        self.restart_tracker()
        time.sleep(0.5)  # it is written once at the start
        before = os.stat(self.store)
        time.sleep(1)  # five times as long as poses are stored after
        after = os.stat(self.store)
        self.assertEqual((after.st_ino, after.st_mtime_ns), (before.st_ino, before.st_mtime_ns))

    def test_in_another_stream_looks_for_objects_and_keeps_where_they_were_registered(self):
        self.begin("overtake")
        shown = self.ctl("model", "show", "van")
        sensor = self.sensor()
        self.eventually(lambda: self.poses("van") and self.poses("van")[-1]["t_us"] > 1_000_000,
                        what="event time 1 s")
        stream = self.poses("van")[-1]["stream_id"]
        sensor.kill()
        self.restart_tracker()
        self.assertEqual(self.ctl("model", "show", "van"), shown)
        self.sensor(start_s=1.5)

        def told(state=None):
            return [p for p in self.poses("van") if p["stream_id"] != stream and
                    state in (None, p["state"])]
        self.eventually(lambda: len(told("TRACKING")) > 100, what="the van is found")
        with open(self.path("truth.csv"), newline="") as file:
            truth = {int(row["t_us"]): float(row["x_px"]) for row in csv.DictReader(file)
                     if row["model"] == "van"}
        found = told("TRACKING")
        print(f"found {(found[0]['t_us'] - told()[0]['t_us']) * 1e-3:.0f} ms after the first pose")
        for pose in found:
            self.assertLess(abs(pose["x_px"] - truth[round(pose["t_us"], -3)]), 5, pose)


if __name__ == "__main__":
    unittest.main(verbosity=2)
