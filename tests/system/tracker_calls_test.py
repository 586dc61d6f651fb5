#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The real tracker, asked from outside: calls are answered with no events flowing, refused by name,
and what they changed outlives a kill."""

import json
import os
import struct
import time
import unittest
import zlib

from pursuit_process import SystemTest


class TrackerCalls(SystemTest):
    def setUp(self):
        super().setUp()
        self.store = self.path("tracker.store")
        self.tracker = self.service("tracker", store=self.store)

    def model(self, name, size_px=10):
        path = self.path(f"model_{name}.csv")
        corners = [(-size_px, -size_px), (size_px, -size_px), (size_px, size_px),
                   (-size_px, size_px)]
        with open(path, "w") as file:
            file.write("x_px,y_px\n" + "".join(f"{x},{y}\n" for x, y in corners))
        return path

    def register(self, name, *arguments, size_px=10, code=0):
        return self.ctl("model", "register", self.model(name, size_px) + "@100,90,0.5", *arguments,
                        code=code)

    def is_stored(self, value):
        """The store is written beside the reply, as a whole: of several calls the last one tells."""
        if not os.path.exists(self.store):
            return False
        with open(self.store, "rb") as file:
            return struct.pack("<d", value) in file.read()

    def status(self):
        return json.loads(self.ctl("status", "--json"))["tracker"]

    def test_models_are_registered_listed_shown_and_removed_with_no_events_flowing(self):
        self.assertIn("is object 1, from 0 us on", self.register("one"))
        self.assertIn("is object 2", self.register("two"))
        self.assertEqual(self.ctl("model", "list").split(), ["one", "two"])
        self.assertIn("x 100.000 px, y 90.000 px", self.ctl("model", "show", "one"))
        self.assertIn("removed", self.ctl("model", "remove", "one"))
        self.assertEqual(self.ctl("model", "list").split(), ["two"])
        self.ctl("model", "show", "one", code=1)
        self.assertIn("'one'", self.ctl_err)
        self.assertIn("is object 3", self.register("one"), "an id is never given again")

    def test_the_status_says_how_many_calls_and_replies_were_lost(self):
        causes = self.status()["dropped_by"]
        self.assertEqual(causes["requests.not_taken"], 0)
        self.assertEqual(causes["writes.replies_failed"], 0)

    def test_identical_content_gives_the_same_id_and_other_content_is_refused(self):
        self.register("one")
        self.assertIn("was already object 1", self.register("one"))
        self.register("one", size_px=12, code=1)
        self.assertIn("'one' is registered as object 1 with other content", self.ctl_err)

    def test_a_strategy_that_is_unknown_or_bad_is_refused_and_the_one_in_force_stays(self):
        before = self.ctl("strategy", "get")
        self.ctl("strategy", "set", "no_such", code=1)
        self.ctl("strategy", "set", "closest", "--set", "ambiguity_px=-1", code=1)
        self.assertIn("ambiguity_px", self.ctl_err)
        self.assertEqual(self.ctl("strategy", "get"), before)

    def test_models_poses_and_settings_come_back_after_a_kill(self):
        self.register("one")
        self.register("two")
        self.ctl("model", "remove", "one")
        self.ctl("strategy", "set", "closest", "--set", "ambiguity_px=2.5")
        shown, strategy = self.ctl("model", "show", "two"), self.ctl("strategy", "get")
        self.eventually(lambda: self.is_stored(2.5), what="the last call is in the store")
        self.tracker.kill()
        begin = time.monotonic()
        self.tracker = self.service("tracker", store=self.store)
        self.assertEqual(self.ctl("model", "list").split(), ["two"])
        took = time.monotonic() - begin
        print(f"answered {took:.2f} s after the kill")
        self.assertLess(took, 5)  # with what it takes to start and to find each other
        self.assertEqual(self.ctl("model", "show", "two"), shown)
        self.assertEqual(self.ctl("strategy", "get"), strategy)
        self.assertIn("was already object 2", self.register("two"))
        self.assertIn("is object 3", self.register("one"))

    def test_a_damaged_store_is_told_and_kept_aside_and_the_tracker_starts_empty(self):
        self.register("one")
        self.assertEqual(self.tracker.stop(), 0)
        with open(self.store, "r+b") as file:
            file.seek(20)
            file.write(b"\xff")
        self.tracker = self.service("tracker", store=self.store)
        self.assertEqual(self.ctl("model", "list"), "")
        status = self.status()
        self.assertEqual(status["errors"], 1)
        self.assertIn("the store is damaged", status["last_error"])
        self.assertTrue(os.path.exists(self.store + ".damaged"))

    def test_a_store_that_cannot_be_read_is_named_and_the_tracker_does_not_start(self):
        self.tracker.kill()
        path = self.path("unreadable.store")
        os.mkdir(path)
        tracker = self.start("pursuit-tracker", "--set", f"store={path}", ready=False)
        self.assertEqual(tracker.wait(10), 1)
        self.assertIn(f"{path}: is no regular file", tracker.err())
        self.assertTrue(os.path.isdir(path))

    def test_a_store_with_a_number_that_no_tracker_has_is_named(self):
        path = self.path("zero.store")
        content = b"\x08\x01\x40\x00"  # format 1, next_object_id 0
        with open(path, "wb") as file:
            file.write(content + b"\x4d" + struct.pack("<I", zlib.crc32(content)))
        tracker = self.start("pursuit-tracker", "--set", f"store={path}", ready=False)
        self.assertEqual(tracker.wait(10), 1)
        self.assertIn(f"{path}: next_object_id: 0", tracker.err())

    def test_the_largest_id_that_may_be_asked_for_leaves_more_also_after_a_restart(self):
        self.register("far", "--object-id", 4294967294, code=1)
        self.assertIn("4294967294 is above 2147483647", self.ctl_err)
        self.assertIn("is object 2147483647", self.register("far", "--object-id", 2147483647))
        self.assertEqual(self.tracker.stop(), 0)
        self.tracker = self.service("tracker", store=self.store)
        self.assertIn("is object 2147483648", self.register("next"))

    def test_a_store_that_another_tracker_has_is_named_and_the_second_does_not_start(self):
        second = self.start("pursuit-tracker", "--set", f"store={self.store}", "--set",
                            f"dds.domain={self.domain.domain}", "--set", "dds.loopback_only=true",
                            ready=False)
        self.assertEqual(second.wait(10), 1)
        self.assertIn(f"{self.store}: the store is in use by another tracker", second.err())
        self.assertTrue(self.tracker.alive())

    def test_a_store_that_is_not_written_is_told_until_it_is_and_loses_nothing(self):
        self.tracker.kill()
        store = self.path("later/tracker.store")
        self.tracker = self.service("tracker", store=store, store_period_ms=20)
        self.register("one")
        status = self.eventually(lambda: self.status()["state"] == "FAULT" and self.status(),
                                 what="a store that is not written is a fault")
        self.assertIn("the store is not written", status["detail"])
        os.mkdir(self.path("later"))
        self.eventually(lambda: self.status()["state"] == "WAITING", what="the store is written")
        self.tracker.kill()
        self.tracker = self.service("tracker", store=store)
        self.assertEqual(self.ctl("model", "list").split(), ["one"])

    def test_sigterm_ends_it_within_two_seconds_with_the_store_written(self):
        self.register("one")
        os.remove(self.store)
        self.assertEqual(self.tracker.stop(), 0, self.tracker.err())
        self.assertLess(self.tracker.stop_s, 2.0)
        self.assertTrue(os.path.exists(self.store))

    def test_an_unreadable_model_in_the_configuration_ends_with_78_and_names_file_and_line(self):
        path = self.path("bad.csv")
        with open(path, "w") as file:
            file.write("x_px,y_px\n1,2\n3,abc\n")
        tracker = self.start("pursuit-tracker", "--set", f"model={path}", ready=False)
        self.assertEqual(tracker.wait(10), 78)
        self.assertIn(f"{path}:3", tracker.err())

    def test_a_status_that_is_watched_leaves_it_out_once_it_was_killed(self):
        watch = self.start("pursuitctl", *self.ctl_arguments("status", "--watch", "--json"),
                           ready=False)

        def shown():
            lines = watch.out().splitlines(keepends=True)
            return [json.loads(line)["tracker"] for line in lines if line.endswith("\n")]
        self.eventually(lambda: shown() and shown()[-1], what="the tracker is shown")
        self.tracker.kill()
        self.eventually(lambda: shown()[-1] is None, what="it is left out")

    def test_a_model_that_was_changed_in_the_configuration_is_told_of_at_the_start(self):
        self.tracker.stop()
        for size_px in 10, 20:
            model = self.model("one", size_px) + "@100,90,0"
            self.tracker = self.service("tracker", store=self.store, model=model)
            said = "model one is as the store has it, not as the configuration: shape"
            self.assertEqual(said in self.tracker.err(), size_px == 20, self.tracker.err())
            self.assertEqual(self.tracker.stop(), 0)

    def test_a_call_is_refused_with_a_clear_message_when_nobody_is_there(self):
        self.tracker.kill()
        self.ctl("model", "list", "--timeout", 300, code=1)
        self.assertIn(f"within 300 ms in domain {self.domain.domain}", self.ctl_err)


if __name__ == "__main__":
    unittest.main(verbosity=2)
