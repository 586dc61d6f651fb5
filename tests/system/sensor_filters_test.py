#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Filters of a running sensor: configured, changed by request, refused, counted; and two sensors."""

import os
import subprocess
import unittest

from pursuit_process import SystemTest, data, program


class Filters(SystemTest):
    def status(self):
        """Of the sensor and the tracker."""
        return self.status_of("sensor"), self.status_of("tracker")

    def test_configured_by_name_drop_what_they_say_and_turn_the_image_for_all_who_read(self):
        events = data("car/car_atis_td.dat")
        tracker = self.service("tracker")
        sensor = self.service("sensor", recording=events, rate=0, wait_for_subscribers=1,
                              exit_at_end=False,
                              filter=["refractory period_us=2000", "polarity keep=1",
                                      "geometry rotate_deg=90"])
        self.eventually(lambda: self.status_of("sensor")["state"] == "FINISHED", what="the recording ends")
        # The last packets may still be on their way when the sensor has ended.
        self.eventually(lambda: self.status_of("tracker")["events_in"] ==
                        self.status_of("sensor")["events_out"], what="the tracker has heard all")
        status, heard = self.status()
        dropped = status["dropped_by"]
        self.assertEqual((status["width"], status["height"]), (240, 304))
        self.assertGreater(dropped["filter.refractory"], 1000)
        self.assertGreater(dropped["filter.polarity"], 1000)
        self.assertEqual(dropped["filter.geometry"], 0)
        self.assertEqual(status["events_in"], 242040)
        self.assertEqual(status["events_out"], 242040 - status["events_dropped"])
        self.assertEqual(status["events_dropped"],
                         dropped["filter.refractory"] + dropped["filter.polarity"])
        self.assertEqual(heard["events_in"], status["events_out"])
        self.assertEqual(heard["events_dropped"], 0)
        self.assertEqual(heard["gaps"], 0)
        self.assertEqual([sensor.stop(), tracker.stop()], [0, 0])

    def test_changed_by_request_take_effect_and_one_that_does_not_fit_changes_nothing(self):
        self.service("tracker")
        self.service("sensor", scene="overtake", rate=0.2, wait_for_subscribers=1)
        rate = lambda: self.status_of("sensor")["dropped_by"]["filter.polarity"]
        self.assertEqual(rate(), 0)
        self.assertEqual(self.status_of("sensor")["dropped_by"]["requests.not_taken"], 0)
        self.ctl("sensor", "filters", "polarity keep=1")
        self.eventually(lambda: rate() > 0, what="OFF events are dropped")
        stream = self.status_of("sensor")["stream_id"]
        for bad, words in ((["refractory period_us=0"], ["period_us is 0", "1 to 1000000000"]),
                           (["polarity", "region_of_interest x_px=9999"], ["filter[1]", "x_px is 9999"]),
                           (["pixel_mask file=/nowhere.textproto"], ["/nowhere.textproto"])):
            self.ctl("sensor", "filters", *bad, code=1)
            for word in words:
                self.assertIn(word, self.ctl_err)
        before = rate()
        self.eventually(lambda: rate() > before, what="the filter before is still in force")
        # Another size of image is another stream; the tracker follows it.
        status, _ = self.status()
        self.ctl("sensor", "filters", "geometry transpose=1")
        size = (status["height"], status["width"])
        self.eventually(lambda: (self.status_of("sensor")["width"], self.status_of("sensor")["height"]) == size,
                        what="the image is transposed")
        turned = self.status_of("sensor")["stream_id"]
        self.assertNotEqual(turned, stream)
        self.eventually(lambda: self.status_of("tracker")["stream_id"] == turned,
                        what="the tracker follows the new stream")
        self.assertEqual(self.status_of("tracker")["dropped_by"]["packets.other_geometry"], 0)
        self.ctl("sensor", "filters", "--none")
        self.eventually(lambda: self.status_of("sensor")["width"] == status["width"],
                        what="the image is as it was")

    def test_by_request_read_no_device_or_fifo_and_tell_nothing_of_what_stands_in_a_file(self):
        sensor = self.service("sensor", scene="overtake", rate=0.2)
        self.eventually(lambda: self.status_of("sensor")["width"], what="the image has a size")
        os.mkfifo(self.path("fifo"))
        with open(self.path("passwd"), "w") as file:
            file.write("secret:x:0:0::/root:/bin/sh\n")
        for name, why in (("/dev/zero", "is not a regular file"),
                          (self.path("fifo"), "is not a regular file"),
                          (self.path("passwd"), "passwd:1:")):
            for kind in ("pixel_mask", "undistort"):
                self.ctl("sensor", "filters", f"{kind} file={name}", code=1)
                self.assertIn(why, self.ctl_err)
                self.assertNotIn("secret", self.ctl_err)
        self.assertEqual(self.status_of("sensor")["state"], "RUNNING")
        self.assertEqual(sensor.stop(), 0)

    def test_that_are_wrong_in_the_configuration_end_the_start_with_78_and_the_field(self):
        for text, words in (("no_such a=1", "no filter is named"),
                            ("refractory period_us=0", "period_us is 0"),
                            ("region_of_interest x_px=70000", "x_px is 70000"),
                            ("region_of_interest x_px=60000", "must be less than"),
                            ("refractory period_us", "is not name=number")):
            done = subprocess.run([program("pursuit-sensor"), "--set", f"filter={text}",
                                   "--set", "scene=overtake", "--check"],
                                  capture_output=True, text=True, timeout=10)
            self.assertEqual(done.returncode, 78, done.stderr)
            self.assertIn("filter[0]", done.stderr)
            self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
