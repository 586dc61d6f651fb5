#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What is wrong is named, and disturbs nothing else."""

import json
import os
import subprocess
import unittest

from pursuit_process import SystemTest, data, program

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")


class BadInput(SystemTest):
    def test_a_typo_in_a_configuration_ends_with_78_and_file_line_and_field(self):
        for service in ("sensor", "tracker", "recorder"):
            path = self.path(f"{service}.textproto")
            with open(path, "w") as file:
                file.write('name: "front"\n\nno_such_key: 1\n')
            done = subprocess.run([program("pursuit-" + service), "--config", path],
                                  capture_output=True, text=True, timeout=10)
            self.assertEqual(done.returncode, 78, done.stderr)
            self.assertIn(f"{path}:3:", done.stderr)
            self.assertIn('"no_such_key"', done.stderr)

    def test_a_value_out_of_range_ends_with_78_and_file_line_and_field(self):
        path = self.path("tracker.textproto")
        with open(path, "w") as file:
            file.write("pose_rate_hz: 0\n")
        done = subprocess.run([program("pursuit-tracker"), "--config", path],
                              capture_output=True, text=True, timeout=10)
        self.assertEqual(done.returncode, 78, done.stderr)
        self.assertIn(f"{path}:1: field pose_rate_hz is 0, must be at least 1", done.stderr)

    def ends_with_78(self, name, content, *options):
        """The service refuses the configuration; gives what it says of it, and its path."""
        path = self.path(name + ".textproto")
        with open(path, "w") as file:
            file.write(content)
        done = subprocess.run([program("pursuit-" + name), "--config", path, *options],
                              capture_output=True, text=True, timeout=10)
        self.assertEqual(done.returncode, 78, done.stderr)
        return done.stderr, path

    def test_what_only_the_service_can_judge_is_told_with_file_line_and_field(self):
        for name, content, line, field in (
                ("tracker", 'name: "a"\nparameter { name: "gate_px" value: 5 }\n'
                            'parameter {\n name: "no_such" value: 1 }\n', 3, "parameter[1]"),
                ("tracker", '\nstrategy: "no_such"\n', 2, "strategy"),
                ("tracker", '\npreset: "no_such"\n', 2, "preset"),
                ("tracker", 'name: "a"\n\nmodel: "no_such.csv"\n', 3, "model[0]"),
                ("sensor", 'scene: "overtake"\nfilter: "polarity"\nfilter: "no_such"\n', 3,
                 "filter[1]"),
                ("sensor", 'name: "a"\nrecording: "no_such.dat"\n', 2, "recording"),
                ("sensor", 'name: "a"\nlive: "tcp://x"\n', 2, "live"),
                ("sensor", 'scene: "overtake"\nlive_format: "no_such"\n', 2, "live_format"),
                ("sensor", 'scene: "overtake"\n\nlive_geometry: "wide"\n', 3, "live_geometry"),
                ("sensor", 'scene: "overtake"\ndds {\n initial_peer: "192.0.2.1"\n'
                           ' initial_peer: "no_such"\n}\n', 4, "dds.initial_peer[1]"),
                ("recorder", '\nreplay: "no_such.mcap"\n', 2, "replay"),
                ("recorder", f'name: "a"\nreplay: "{__file__}"\n', 2, "replay"),
                ("recorder", 'name: "a"\noutput: "/tmp"\n', 2, "output"),
                ("recorder", 'output: "a.mcap"\ntopic: "pursuit/events"\ntopic: "no_such"\n', 3,
                 "topic[1]")):
            said, path = self.ends_with_78(name, content)
            self.assertIn(f"{path}:{line}: field {field}", said)
            checked, path = self.ends_with_78(name, content, "--check")
            self.assertIn(f"{path}:{line}: field {field}", checked)

    def test_what_a_setting_has_broken_is_told_with_the_setting(self):
        said, path = self.ends_with_78("tracker", 'strategy: "weighted"\n', "--set",
                                       "strategy=no_such")
        self.assertIn("--set strategy=no_such: field strategy", said)
        self.assertNotIn(path, said)

    def test_a_key_given_twice_and_one_that_is_missing_are_told_with_file_and_line(self):
        for name in ("sensor", "tracker", "recorder"):
            said, path = self.ends_with_78(name, 'name: "a"\n\nname: "b"\n')
            self.assertIn(f"{path}:3:", said)
            self.assertIn('"name" is specified multiple times', said)
        said, path = self.ends_with_78("tracker", '\nparameter { name: "gate_px" }\n')
        self.assertIn(f"{path}:2: field parameter[0].value is missing", said)

    def test_offline_tracking_names_file_line_and_field_of_its_configuration(self):
        path = self.path("tracker.textproto")
        with open(path, "w") as file:
            file.write('name: "a"\nstrategy: "no_such"\n')
        arguments = ["track", "--events", "none.dat", "--poses", self.path("poses.csv"),
                     "--config", path]
        self.ctl(*arguments, code=78, dds=False)
        self.assertIn(f"{path}:2: field strategy: unknown", self.ctl_err)
        self.ctl(*arguments, "--strategy", "nor_this", code=78, dds=False)
        self.assertIn("--strategy nor_this: field strategy: unknown", self.ctl_err)

    def test_two_objects_of_one_name_are_refused_by_the_tracker_and_offline(self):
        model = self.path("van.csv")
        with open(model, "w") as file:
            file.write("x_px,y_px\n0,0\n20,0\n0,20\n")
        events = self.path("events.txt")
        with open(events, "w") as file:
            file.write("0.1 1 1 1\n")
        first, second = model + "@36,138,0", model + "@136,138,0"
        both = f"two models are named van, {first} and {second}"
        said, path = self.ends_with_78("tracker", f'model: "{first}"\nmodel: "{second}"\n')
        self.assertIn(f"{path}:2: field model[1]: {both}", said)
        self.ctl("track", "--events", events, "--poses", self.path("poses.csv"),
                 "--model", first, "--model", second, code=1, dds=False)
        self.assertIn(both, self.ctl_err)

    def test_a_range_without_an_event_ends_with_1_and_says_so(self):
        events = self.path("events.txt")
        with open(events, "w") as file:
            file.write("0.1 1 1 1\n0.2 1 1 1\n")
        for settings, text in (({"start_s": 50}, "start_s 50 to its end"),
                               ({"start_s": 0.11, "end_s": 0.12}, "start_s 0.11 to end_s 0.12")):
            sensor = self.service("sensor", recording=events, rate=0, **settings)
            self.assertEqual(sensor.wait(10), 1)
            self.assertIn(f"{events}: no event lies within {text}", sensor.err())
        sensor = self.service("sensor", recording=events, rate=0, start_s=0.15)
        self.assertEqual(sensor.wait(10), 0)

    def test_a_live_source_that_is_not_there_is_named_when_the_sensor_is_ready(self):
        path = self.path("not_there")
        sensor = self.service("sensor", live=path)
        self.eventually(lambda: "ready: " in sensor.err(), what="the sensor says that it is ready")
        self.assertRegex(sensor.err(), f"ready: waiting for .*{path}")

    def test_the_sample_configurations_are_good(self):
        for service in ("tracker", "recorder", "sensor"):
            path = os.path.join(SOURCE, "deploy/config", service + ".textproto")
            done = subprocess.run([program("pursuit-" + service), "--config", path, "--check"],
                                  capture_output=True, text=True, timeout=10)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_damaged_recording_is_named_with_offset_and_what_was_good_before_it_arrives(self):
        damaged = data("malformed/dat_truncated_mid_event.dat")
        tracker = self.service("tracker")
        sensor = self.service("sensor", recording=damaged, rate=0, wait_for_subscribers=1)
        self.assertEqual(sensor.wait(10), 1)
        self.assertIn(f"{damaged}: byte 4093: ", sensor.err())
        # Every whole event before the cut: 8 bytes each, behind the header's lines and 2 bytes.
        with open(damaged, "rb") as file:
            content = file.read()
        header = 0
        while content[header:header + 1] == b"%":
            header = content.index(b"\n", header) + 1
        good = (len(content) - header - 2) // 8
        self.assertGreater(good, 100)
        status = self.eventually(
            lambda: (lambda s: s if s["events_in"] >= good else None)(self.tracker_status()),
            what=f"{good} good events arrive")
        self.assertEqual(status["events_in"], good)
        self.assertEqual(status["gaps"], 0)
        self.assertTrue(tracker.alive())

    def test_a_time_beyond_285_years_is_an_error_with_its_line_and_the_sensor_ends(self):
        path = self.path("late.csv")
        with open(path, "w") as file:
            file.write("# geometry 4x4\n10,1,1,1\n9223372036854775807,1,1,1\n")
        sensor = self.service("sensor", recording=path, rate=0, exit_at_end=True)
        self.assertEqual(sensor.wait(10), 1)
        self.assertIn(f"{path}: byte 24: line 3: time 9223372036854775807 us", sensor.err())

    def test_a_recording_without_events_is_told_and_a_loop_of_it_ends_as_a_fault(self):
        empty = self.path("empty.csv")
        with open(empty, "w") as file:
            file.write("# geometry 4x4\n")
        sensor = self.service("sensor", recording=empty)
        self.assertEqual(sensor.wait(10), 0)
        self.assertIn(f"{empty}: has no event", sensor.err())
        sensor = self.service("sensor", recording=empty, loop=True)
        self.assertEqual(sensor.wait(10), 1)
        self.assertIn(f"{empty}: has no event, nothing to repeat", sensor.err())

    def tracker_status(self):
        return json.loads(self.ctl("status", "--json"))["tracker"]

    def test_a_malformed_sample_is_counted_and_the_next_good_request_is_served(self):
        tracker = self.service("tracker")
        writer = os.path.join(os.environ.get("PURSUIT_TESTS", ""), "malformed_writer")
        done = subprocess.run([writer, str(self.domain.domain)], capture_output=True, text=True,
                              timeout=20)
        self.assertEqual(done.returncode, 0, done.stderr)
        print(done.stdout.strip())
        sent = int(done.stdout.split()[0])
        self.assertGreaterEqual(sent, 10)
        counted = self.eventually(
            lambda: (lambda n: n if n >= sent else None)(self.tracker_status()["malformed_samples"]),
            what="every malformed sample is counted")
        self.assertEqual(counted, sent)
        self.assertEqual(self.ctl("model", "list").strip(), "")
        self.assertTrue(tracker.alive())

    def test_an_invalid_request_is_refused_with_field_and_bound_and_changes_nothing(self):
        self.service("tracker")
        path = self.path("model_bad.csv")
        with open(path, "w") as file:
            file.write("x_px,y_px\n0,0\n20,0\n0,20\n")
        self.ctl("model", "register", path + "@10,10,0", "--set", "gate_px=-1", code=1)
        self.assertIn("gate_px", self.ctl_err)
        self.ctl("strategy", "set", "no_such_strategy", code=1)
        self.ctl("model", "remove", "no-such-model", code=1)
        self.assertIn("no-such-model", self.ctl_err)
        self.assertEqual(self.ctl("model", "list").strip(), "")

    def test_a_table_of_poses_that_cannot_be_created_is_named_and_ends_with_1(self):
        self.service("tracker")
        path = self.path("no/such/folder/poses.csv")
        self.ctl("poses", "--csv", path, "--for", "5", code=1)
        self.assertIn(f"{path}: cannot create: ", self.ctl_err)


if __name__ == "__main__":
    unittest.main(verbosity=2)
