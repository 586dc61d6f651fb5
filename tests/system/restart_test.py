#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""kill -9 and restart of each process during a run: the others go on, and tell what was missed."""

import csv
import json
import os
import time
import unittest

from pursuit_process import SystemTest


class Restart(SystemTest):
    def setUp(self):
        super().setUp()
        self.ctl("simulate", "overtake", "--seed", 3, "--events", self.path("events.dat"),
                 "--truth", self.path("truth.csv"), "--models", self.path("models"), dds=False,
                 timeout=120)
        with open(self.path("models/start.csv"), newline="") as file:
            self.starts = list(csv.DictReader(file))
        self.truth = {}
        with open(self.path("truth.csv"), newline="") as file:
            for row in csv.DictReader(file):
                rows = self.truth.setdefault(row["model"], {})
                rows[int(row["t_us"])] = float(row["x_px"]), float(row["y_px"])
        self.store = self.path("tracker.store")
        self.tracker = self.service("tracker", store=self.store)
        for start in self.starts:
            name = start["object"]
            self.ctl("model", "register", self.path(f"models/model_{name}.csv") +
                     f"@{start['x_px']},{start['y_px']},{start['theta_rad']}")

    def sensor(self, **fields):
        return self.service("sensor", recording=self.path("events.dat"), **fields)

    def last_pose(self, model="van", timeout=2):
        """The next pose of a model, as a dict, with the seconds that it took to come."""
        begin = time.monotonic()
        text = self.ctl("poses", "--json", "--model", model, "--count", 1, "--for", timeout)
        pose = json.loads(text.splitlines()[0])
        pose["after_s"] = time.monotonic() - begin
        return pose

    def viewer(self):
        """Somebody who watches all the time: what comes back is counted by who was there before."""
        process = self.start("pursuitctl", *self.ctl_arguments("poses", "--json", "--for", 60),
                             ready=False)
        self.eventually(lambda: process.out().count("\n") > 0, what="the viewer sees a pose")
        return process

    def next_pose(self, viewer, seen, wanted):
        """The viewer's first pose after those seen that is wanted, with the time it came at."""
        def found():
            for line in viewer.out()[seen:].splitlines(keepends=True):
                if line.endswith("\n") and wanted(json.loads(line)):
                    return json.loads(line), time.monotonic()
            return None
        return self.eventually(found, timeout=5, what="a wanted pose")

    def truth_at(self, model, t_us):
        """Of each whole millisecond; the last beyond the end."""
        rows = self.truth[model]
        return rows.get(round(t_us, -3)) or rows[max(rows)]

    def status(self, service):
        return json.loads(self.ctl("status", "--json"))[service]

    def test_of_the_tracker_resumes_poses_from_the_stored_ones(self):
        sensor = self.sensor(wait_for_subscribers=1)
        self.eventually(lambda: self.last_pose()["t_us"] > 1_000_000, what="event time 1 s")
        viewer = self.viewer()
        self.tracker.kill()
        killed = time.monotonic()
        time.sleep(0.05)
        seen = viewer.out().rfind("\n") + 1  # not within a line
        self.tracker = self.service("tracker", store=self.store)
        pose, came = self.next_pose(viewer, seen, lambda p: p["model"] == "van")
        took = came - killed
        x_px, y_px = self.truth_at("van", pose["t_us"])
        print(f"poses resumed {took:.2f} s after the kill, "
              f"{abs(pose['x_px'] - x_px):.2f} px from the truth in x")
        self.assertLess(took, 5)  # with what it takes to start and to find each other
        self.assertEqual(pose["object_id"], 1)
        self.assertLess(abs(pose["x_px"] - x_px), 30)
        time.sleep(0.5)
        pose = self.last_pose()
        x_px, y_px = self.truth_at("van", pose["t_us"])
        self.assertEqual(pose["state"], "TRACKING")
        self.assertLess(abs(pose["x_px"] - x_px), 3)
        self.assertTrue(sensor.alive())

    def test_of_the_sensor_leaves_the_tracker_running_and_poses_resume(self):
        sensor = self.sensor(wait_for_subscribers=1, start_s=1.0)
        self.eventually(lambda: self.last_pose()["t_us"] > 1_300_000, what="event time 1.3 s")
        viewer = self.viewer()
        sensor.kill()
        # Silence is the sensor's fault, not the track's.
        self.eventually(lambda: self.status("tracker")["sensor_silent"], what="silence is noticed")
        stream = self.status("tracker")["stream_id"]
        seen = viewer.out().rfind("\n") + 1  # not within a line
        restarted = time.monotonic()
        self.sensor(start_s=1.3)
        pose, came = self.next_pose(viewer, seen, lambda p: p["model"] == "van" and
                                    p["t_us"] > 1_300_000 and p["stream_id"] != stream)
        took = came - restarted
        print(f"poses resumed {took:.2f} s after the sensor's restart")
        self.assertLess(took, 5)  # with what it takes to start and to find each other
        self.assertEqual(pose["object_id"], 1)
        # The objects have moved while nobody looked: they are searched for, and told lost so long.
        def is_found(pose):
            x_px, y_px = self.truth_at(pose["model"], pose["t_us"])
            return abs(pose["x_px"] - x_px) < 3 and abs(pose["y_px"] - y_px) < 3

        for model in ("van", "car"):
            pose, came = self.next_pose(viewer, seen, lambda p: p["model"] == model and
                                        p["stream_id"] != stream and p["state"] == "TRACKING" and
                                        is_found(p))
            print(f"{model} found {came - restarted:.2f} s after the sensor's restart")
        self.assertTrue(self.tracker.alive())
        status = self.status("tracker")
        self.assertFalse(status["sensor_silent"])
        self.assertEqual(status["packets_missed"], 0)

    def test_of_the_recorder_leaves_its_file_readable_up_to_the_last_flushed_chunk(self):
        first, second = self.path("first.mcap"), self.path("second.mcap")
        recorder = self.service("recorder", output=first)
        sensor = self.sensor(wait_for_subscribers=2)
        self.eventually(lambda: self.last_pose()["t_us"] > 1_500_000, what="event time 1.5 s")
        recorder.kill()
        size = os.path.getsize(first)
        recorder = self.service("recorder", output=second)
        pose = self.last_pose()
        self.assertTrue(sensor.alive() and self.tracker.alive())
        info = self.ctl("info", first, dds=False, code=1)
        print(info.strip().splitlines()[0], f"({size} bytes)")
        self.assertIn("pursuit/events", info)
        self.assertIn("pursuit/poses", info)
        facts = json.loads(self.ctl("info", first, "--json", dds=False, code=1))
        self.assertGreater(facts["duration_s"], 0.8)
        self.assertFalse(facts["closed_cleanly"])
        time.sleep(0.5)
        self.assertEqual(recorder.stop(), 0, recorder.err())
        self.assertGreater(pose["t_us"], 1_500_000)
        self.assertTrue(json.loads(self.ctl("info", second, "--json", dds=False))["closed_cleanly"])

    def test_of_any_service_by_sigterm_ends_within_two_seconds(self):
        recorder = self.service("recorder", output=self.path("a.mcap"))
        sensor = self.sensor()
        for process in (sensor, self.tracker, recorder):
            self.assertEqual(process.stop(), 0, process.err())
            print(f"{process.name} ended after {process.stop_s:.2f} s")
            self.assertLess(process.stop_s, 2.0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
