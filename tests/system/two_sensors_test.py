#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Two sensors and two trackers on one host and one domain: neither hears the other's."""

import csv
import os
import unittest

from pursuit_process import SystemTest


class TwoSensors(SystemTest):
    NAMES = {"left": 1, "right": 2}

    def rows(self, name):
        with open(self.path(name), newline="") as file:
            return [line for line in file.read().splitlines() if line]

    def simulated(self, name, scene, seed):
        """Events and models of a scene, and the poses that tracking them offline gives."""
        events = self.path(f"{name}.dat")
        models = self.path(name)
        self.ctl("simulate", scene, "--seed", seed, "--events", events, "--truth",
                 self.path(f"{name}.truth.csv"), "--models", models, dds=False, timeout=120)
        with open(os.path.join(models, "start.csv"), newline="") as file:
            start = next(csv.DictReader(file))
        model = (f"{models}/model_{start['object']}.csv@{start['x_px']},{start['y_px']},"
                 f"{start['theta_rad']}")
        self.ctl("track", "--events", events, "--model", model, "--transform", "isometry",
                 "--poses", self.path(f"{name}.offline.csv"), dds=False, timeout=60)
        return events, model

    def test_by_name_and_id_give_each_tracker_its_own_events_and_the_poses_of_each_alone(self):
        scenes = {"left": ("star_670rpm", 5), "right": ("disc_P_670rpm", 6)}
        made = {name: self.simulated(name, *scene) for name, scene in scenes.items()}
        trackers, viewers, sensors = {}, {}, {}
        for name, sensor_id in self.NAMES.items():
            trackers[name] = self.service("tracker", name=name, sensor_id=sensor_id)
        for name in self.NAMES:
            self.ctl("model", "register", made[name][1], "--transform", "isometry", "--name", name)
            self.assertEqual(self.ctl("model", "list", "--name", name).split(),
                             [os.path.basename(made[name][1]).split(".")[0][len("model_"):]])
            count = len(self.rows(f"{name}.offline.csv")) - 1
            viewers[name] = self.start("pursuitctl", *self.ctl_arguments(
                "poses", "--csv", self.path(f"{name}.live.csv"), "--count", count, "--for", 30,
                "--name", name), ready=False)
        for name in self.NAMES:
            self.eventually(lambda: os.path.exists(self.path(f"{name}.live.csv")) and
                            os.path.getsize(self.path(f"{name}.live.csv")) > 0,
                            what="the tracker is found")
        for name, sensor_id in self.NAMES.items():
            sensors[name] = self.service("sensor", name=name, sensor_id=sensor_id,
                                         recording=made[name][0], wait_for_subscribers=2,
                                         exit_at_end=False)
        # A request for one is not heard by the other.
        self.ctl("sensor", "pause", "--name", "left")
        self.eventually(lambda: self.status_of("sensor", "left")["state"] == "PAUSED",
                        what="the left sensor pauses")
        self.assertNotEqual(self.status_of("sensor", "right")["state"], "PAUSED")
        self.ctl("sensor", "resume", "--name", "left")
        for name in self.NAMES:
            self.assertEqual(viewers[name].wait(40), 0, viewers[name].err())
            self.assertEqual(self.rows(f"{name}.live.csv"), self.rows(f"{name}.offline.csv"))
        for name, sensor_id in self.NAMES.items():
            self.eventually(lambda: self.status_of("sensor", name)["state"] == "FINISHED",
                            what="the recording ends")
            sensor = self.status_of("sensor", name)
            heard = self.eventually(
                lambda: (lambda t: t if t["events_in"] >= sensor["events_out"] else None)(
                    self.status_of("tracker", name)), what="the tracker has every event")
            self.assertEqual((heard["events_in"], heard["sensor_id"], heard["stream_id"]),
                             (sensor["events_out"], sensor_id, sensor["stream_id"]))
            self.assertEqual((heard["gaps"], heard["events_dropped"]), (0, 0))


if __name__ == "__main__":
    unittest.main(verbosity=2)
