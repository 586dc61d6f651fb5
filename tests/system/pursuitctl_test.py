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


if __name__ == "__main__":
    unittest.main(verbosity=2)
