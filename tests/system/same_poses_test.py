#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The same events give the same poses, bit for bit: offline, live, live again, and replayed."""

import csv
import os
import unittest

from pursuit_process import SystemTest, data


def rows(path):
    with open(path, newline="") as file:
        return [line.rstrip("\n") for line in file if line.strip()]


class SamePoses(SystemTest):
    """On the real recording of a passing car where it is there, and on a simulated star."""

    def wait_listening(self, name):
        """pursuitctl writes the header when it has found the tracker."""
        self.eventually(lambda: os.path.exists(self.path(name)) and
                        os.path.getsize(self.path(name)) > 0, what="the tracker is found")

    def live(self, name, sensor_fields, model, transform, count, record=None):
        """One run through real processes; gives the lines of the poses that arrived."""
        recorder = self.service("recorder", output=record) if record else None
        tracker = self.service("tracker")
        self.ctl("model", "register", model, "--transform", transform)
        poses = self.start("pursuitctl", *self.ctl_arguments(
            "poses", "--csv", self.path(name), "--count", count, "--for", 30), ready=False)
        self.wait_listening(name)
        sensor = self.service("sensor", wait_for_subscribers=2 if record else 1, **sensor_fields)
        self.assertEqual(sensor.wait(60), 0, sensor.err())
        self.assertEqual(poses.wait(40), 0, poses.err())
        for process in filter(None, [recorder, tracker]):
            self.assertEqual(process.stop(), 0, process.err())
        return rows(self.path(name))

    def replayed(self, name, recording, count):
        tracker = self.service("tracker")
        poses = self.start("pursuitctl", *self.ctl_arguments(
            "poses", "--csv", self.path(name), "--count", count, "--for", 30), ready=False)
        self.wait_listening(name)
        recorder = self.service("recorder", replay=recording)
        self.assertEqual(recorder.wait(60), 0, recorder.err())
        self.assertEqual(poses.wait(40), 0, poses.err())
        self.assertEqual(tracker.stop(), 0)
        return rows(self.path(name))

    def check(self, events, sensor_fields, model, transform, track_arguments):
        self.ctl("track", "--events", events, "--model", model, "--transform", transform,
                 *track_arguments, "--poses", self.path("offline.csv"), dds=False, timeout=60)
        offline = rows(self.path("offline.csv"))
        count = len(offline) - 1
        self.assertGreater(count, 300)
        recording = self.path("run.mcap")
        live = self.live("live.csv", sensor_fields, model, transform, count, recording)
        self.assertEqual(live, offline, "live against offline")
        again = self.live("again.csv", sensor_fields, model, transform, count)
        self.assertEqual(again, offline, "a second live run against offline")
        replayed = self.replayed("replayed.csv", recording, count)
        self.assertEqual(replayed, offline, "replayed against offline")
        print(f"{count} poses, four times the same bits")

    def test_of_the_real_car_are_the_same_offline_live_and_replayed(self):
        events = data("car/car_atis_td.dat")
        model = self.path("car.model.textproto")
        self.ctl("model", "extract", "--events", events, "--at", 1.60, "--window", 20,
                 "--roi", "20,140,140,60", "--points", 150, "--output", model, dds=False)
        self.check(events, {"recording": events, "start_s": 1.61, "end_s": 2.2}, model,
                   "similarity", ["--from", 1.61, "--to", 2.2])

    def test_of_a_simulated_star_are_the_same_offline_live_and_replayed(self):
        events = self.path("star.dat")
        self.ctl("simulate", "star_670rpm", "--seed", 5, "--events", events, "--truth",
                 self.path("truth.csv"), "--models", self.path("models"), dds=False, timeout=120)
        with open(self.path("models/start.csv"), newline="") as file:
            start = next(csv.DictReader(file))
        model = (f"{self.path('models/model_star.csv')}@{start['x_px']},{start['y_px']},"
                 f"{start['theta_rad']}")
        self.check(events, {"recording": events}, model, "isometry", [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
