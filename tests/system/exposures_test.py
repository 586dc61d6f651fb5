#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Exposure measurements of a real ATIS: published, recorded, replayed, and made into images."""

import json
import unittest

from pursuit_process import SystemTest, data

EVENTS, EXPOSURES = 242040, 442382  # README of the recordings


class Exposures(SystemTest):
    def image(self, events, name):
        self.ctl("grey", "--events", events, "--at", 1.95, "--output", self.path(name), dds=False)
        with open(self.path(name), "rb") as file:
            return file.read()

    def topics(self, recording):
        info = json.loads(self.ctl("info", recording, "--json", dds=False))
        return {channel["topic"]: channel["messages"] for channel in info["channels"]}

    def test_go_the_whole_way_and_give_the_same_image_from_everywhere(self):
        events = data("car/car_atis_td_em.es")
        first, second = self.path("first.mcap"), self.path("second.mcap")
        recorder = self.service("recorder", output=first)
        self.service("sensor", recording=events, rate=4, wait_for_subscribers=1,
                     exit_at_end=False)
        status = self.eventually(
            lambda: (lambda s: s if s["state"] == "FINISHED" else None)(self.status_of("sensor")),
            what="the recording ends")
        self.assertEqual((status["events_out"], status["exposures_out"]), (EVENTS, EXPOSURES))
        heard = self.status_of("recorder")
        self.assertEqual((heard["gaps"], heard["messages_dropped"]), (0, 0))
        self.assertEqual(recorder.stop(), 0, recorder.err())
        topics = self.topics(first)
        self.assertGreater(topics["pursuit/exposures"], 1000)
        image = self.image(events, "file.png")
        self.assertEqual(self.image(first, "recorded.png"), image)

        recorder = self.service("recorder", output=second)
        replay = self.service("recorder", replay=first, rate=4)
        self.assertEqual(replay.wait(30), 0, replay.err())
        self.assertEqual(recorder.stop(), 0, recorder.err())
        again = self.topics(second)
        for topic in ("pursuit/events", "pursuit/exposures"):
            self.assertEqual(again[topic], topics[topic], topic)
        self.assertEqual(self.image(second, "replayed.png"), image)

    def test_are_turned_with_the_events(self):
        events = data("car/car_atis_td_em.es")
        turned = self.path("turned.mcap")
        recorder = self.service("recorder", output=turned)
        sensor = self.service("sensor", recording=events, rate=4, end_s=0.5, wait_for_subscribers=1,
                              filter=["refractory period_us=5000", "geometry rotate_deg=90"])
        self.assertEqual(sensor.wait(30), 0, sensor.err())
        self.assertEqual(recorder.stop(), 0, recorder.err())
        out = self.ctl("grey", "--events", turned, "--at", 0.5, "--output", self.path("turned.png"),
                       dds=False)
        self.assertIn("240x304", out)
        plain = self.ctl("grey", "--events", events, "--at", 0.5, "--output",
                         self.path("plain.png"), dds=False)
        self.assertIn("304x240", plain)
        # As many pixels are measured: no filter of events took measurements out.
        self.assertEqual(out.split(",")[1].split()[0], plain.split(",")[1].split()[0])


if __name__ == "__main__":
    unittest.main(verbosity=2)
