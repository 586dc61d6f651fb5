#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""pursuitctl on files: what is wrong is said, also by the exit code, and no file is spoilt."""

import os
import subprocess
import unittest

from pursuit_process import SystemTest, program


class Pursuitctl(SystemTest):
    def offline(self, *arguments, code=0):
        return self.ctl(*arguments, code=code, dds=False)

    def write(self, path, text):
        with open(path, "w", encoding="latin-1") as file:
            file.write(text)

    def read(self, path):
        with open(path, encoding="latin-1", newline="") as file:
            return file.read()

    def simulate(self, *arguments):
        """A short scene; gives the paths of its events and truth."""
        events, truth = self.path("run.dat"), self.path("truth.csv")
        self.offline("simulate", "overtake", "--duration", "0.05", "--events", events, "--truth",
                     truth, "--models", self.path("models"), *arguments)
        return events, truth

    def test_a_result_that_a_full_disk_does_not_take_ends_with_1_and_says_so(self):
        events, truth = self.simulate()
        van = self.path("models/model_van.csv")
        commands = [["parameters"], ["strategy", "list"], ["sensor", "filter-kinds"], ["--help"],
                    ["info", events], ["convert", events, self.path("run.csv")],
                    ["simulate", "overtake", "--duration", "0.01", "--truth", self.path("t.csv")],
                    ["evaluate", "--poses", truth, "--truth", truth, "--from", "0", "--model", van]]
        for arguments in commands:
            with open("/dev/full", "wb") as full:
                done = subprocess.run([program("pursuitctl"), *arguments], stdout=full,
                                      stderr=subprocess.PIPE, timeout=30, text=True)
            self.assertEqual(done.returncode, 1, f"{arguments}: {done.stderr}")
            self.assertIn("standard output: cannot write", done.stderr)

    def test_no_output_of_a_simulation_is_its_scene_or_its_other_output(self):
        scene, events = self.path("own.scene.textproto"), self.path("run.csv")
        text = 'name: "own" duration_s: 0.01\n'
        self.write(scene, text)
        self.offline("simulate", scene, "--truth", scene, code=1)
        self.assertIn(f"{scene}: is the input", self.ctl_err)
        self.assertEqual(self.read(scene), text)
        self.offline("simulate", scene, "--events", events, "--truth", events, code=1)
        self.assertIn(f"{events}: is also the output", self.ctl_err)
        self.assertFalse(os.path.exists(events))

    def test_a_simulation_that_cannot_write_all_leaves_the_events_that_were_there(self):
        events, truth = self.simulate()
        for path in (events, truth):
            self.write(path, "of an earlier run")
        no_folder = self.path("no/such/folder/truth.csv")
        for output in (["--truth", no_folder], ["--truth", truth, "--models", events]):
            self.offline("simulate", "overtake", "--duration", "0.01", "--events", events, *output,
                         code=1)
            self.assertEqual(self.read(events), "of an earlier run", output)
            self.assertEqual(self.read(truth), "of an earlier run", output)

    def test_the_poses_of_track_are_not_written_over_what_it_reads(self):
        events, _ = self.simulate()
        model, edges = self.path("models/model_van.csv"), self.path("models/model_van_edges.csv")
        config = self.path("tracker.textproto")
        self.write(config, "pose_rate_hz: 1000\n")
        for path in (model, edges, config, events):
            before = self.read(path)
            self.offline("track", "--events", events, "--model", model + "@36,138,0", "--config",
                         config, "--poses", path, code=1)
            self.assertIn(f"{path}: is the input", self.ctl_err)
            self.assertEqual(self.read(path), before)

    def test_the_page_of_a_report_is_not_written_over_the_truth(self):
        recording, truth = self.path("run.mcap"), self.path("truth.csv")
        self.write(recording, "")
        self.write(truth, "t_us\n")
        self.offline("report", recording, "--truth", truth, "--output", truth, code=1)
        self.assertIn(f"{truth}: is the input", self.ctl_err)
        self.assertEqual(self.read(truth), "t_us\n")

    def test_evaluate_names_the_option_or_the_column_that_makes_no_sense(self):
        _, truth = self.simulate()
        good = ["evaluate", "--poses", truth, "--truth", truth, "--model",
                self.path("models/model_van.csv"), "--from", "0"]
        self.assertIn("van", self.offline(*good))
        for wrong in (["--speed-window", "nan"], ["--speed-window", "inf"], ["--fresh", "-1"],
                      ["--fresh", "nan"]):
            self.offline(*good, *wrong, code=105)
            self.assertIn(wrong[0], self.ctl_err)
        for from_s, to_s in (("nan", "0"), ("-5", "0"), ("0", "-1"), ("5", "3"), ("3", "3")):
            self.offline(*good[:-1], from_s, "--to", to_s, code=1)
            self.assertIn("--from, --to: a range must", self.ctl_err)
        self.offline(*good[:-1], "5", code=1)
        self.assertIn("no row of the truth lies in the scored range", self.ctl_err)
        self.offline(*good, "--symmetry", "foo=3", code=1)
        self.assertIn('--symmetry: "foo" is the name of none of the models', self.ctl_err)
        poses = self.path("misspelt.csv")
        self.write(poses, self.read(truth).replace("x_px", "x_pz", 1))
        self.offline("evaluate", "--poses", poses, *good[3:], code=1)
        self.assertIn(f"{poses}: has no column x_px", self.ctl_err)

    def test_report_prints_what_is_wrong_with_a_recording_and_check_fails_for_it(self):
        events, _ = self.simulate()
        recording, page = self.path("run.mcap"), self.path("page.html")
        recorder = self.service("recorder", output=recording)
        sensor = self.service("sensor", recording=events, rate=0, wait_for_subscribers=1)
        self.assertEqual(sensor.wait(20), 0, sensor.err())
        self.assertEqual(recorder.stop(), 0, recorder.err())
        self.assertNotIn("recording: ", self.offline("report", recording, "--output", page))
        with open(recording, "r+b") as file:
            middle = os.path.getsize(recording) // 2
            file.seek(middle)
            byte = file.read(1)[0]
            file.seek(middle)
            file.write(bytes([byte ^ 1]))
        text = self.offline("report", recording, "--output", page, "--check", code=1)
        self.assertIn(f"recording: {recording}: byte ", text)
        self.assertRegex(text, "faults in the recording +2\n")

    def test_a_word_that_is_unknown_is_named(self):
        for arguments in (["nosuch"], ["model", "nosuch"], ["track", "nosuch", "--poses", "p.csv"]):
            self.offline(*arguments, code=109)
            self.assertIn('"nosuch" is no command or option here', self.ctl_err)
        self.offline("track", code=106)
        self.assertIn("--events is required", self.ctl_err)

    def test_a_number_that_makes_no_sense_is_refused_with_its_option(self):
        truth = ["--truth", self.path("truth.csv")]
        for arguments in (["simulate", "overtake", *truth, "--seed", "-1"],
                          ["simulate", "overtake", *truth, "--duration", "nan"],
                          ["poses", "--count", "-1"], ["poses", "--for", "-1"],
                          ["poses", "--for", "nan"], ["report", "a.mcap", "--slice-ms", "nan"]):
            self.offline(*arguments, code=105)
            self.assertIn(arguments[-2], self.ctl_err)

    def test_track_says_that_no_event_lies_in_the_range(self):
        events, _ = self.simulate()
        track = ["track", "--events", events, "--model",
                 self.path("models/model_van.csv") + "@36,138,0", "--poses", self.path("p.csv")]
        self.offline(*track, "--from", "0.01")
        self.offline(*track, "--from", "100", code=1)
        self.assertIn(f"{events}: no event lies in the range of --from and --to", self.ctl_err)

    def test_convert_says_that_no_event_lies_in_the_range_and_leaves_what_was_there(self):
        events, _ = self.simulate()
        output = self.path("part.csv")
        self.write(output, "of an earlier run")
        for part in (["--from", "100"], ["--from", "100", "--to", "101"]):
            self.offline("convert", events, output, *part, code=1)
            self.assertIn(f"{events}: no event lies in the range of --from and --to", self.ctl_err)
            self.assertEqual(self.read(output), "of an earlier run")
        self.offline("convert", events, output, "--from", "0.01")
        self.assertGreater(len(self.read(output).splitlines()), 10)
        nothing = self.path("nothing.csv")
        self.write(nothing, "# geometry 64x32\n")
        self.assertIn("0 events", self.offline("convert", nothing, output))

    def test_info_reads_a_pipe_from_its_first_byte(self):
        events, _ = self.simulate()
        pipe = self.path("pipe")
        os.mkfifo(pipe)
        expected = self.offline("info", events)
        with subprocess.Popen(["sh", "-c", 'cat "$0" > "$1"', events, pipe]) as writer:
            self.assertEqual(self.offline("info", pipe, "--format", "dat"), expected)
            self.assertEqual(writer.wait(), 0)

    def test_the_help_of_model_register_tells_its_estimator_whatever_the_preset(self):
        text = " ".join(self.offline("model", "register", "--help").split())
        self.assertIn("without: kalman, whatever the tracker's preset", text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
