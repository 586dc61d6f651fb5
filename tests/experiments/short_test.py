#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A short subset of the experiments, from nothing to pages; and what they must show at the least."""

import csv
import os
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))


def table(path, first):
    """{first cell: row as {column: cell}} of the table whose header begins with `first`."""
    rows = {}
    header = None
    with open(path, newline="") as file:
        for row in csv.reader(file):
            if not row:
                header = None
            elif header is None:
                header = row
            elif header[0] == first:
                rows.setdefault(row[0], dict(zip(header, row)))
    return rows


class ShortExperiments(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.run_groups()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def run_groups(cls):
        done = subprocess.run([os.path.join(HERE, "run.sh"), "rotating_star", "--quick", "--seeds",
                               "1", "--out", cls.folder.name], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr[-2000:]

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def test_the_star_is_kept_and_scores_as_the_true_pose_does(self):
        rows = table(self.path("rotating_star.csv"), "method")
        for method, most_px in (("default", 0.2), ("gradient, best constants", 0.35)):
            lost, error = rows[method]["lost / E, px"].split(" / ")
            self.assertEqual(lost, "0 of 1", method)
            self.assertLessEqual(float(error), most_px, method)
            self.assertLessEqual(float(rows[method]["D1, px"]),
                                 1.02 * float(rows["true pose"]["D1, px"]) + 0.005, method)

    def test_pages_are_whole_and_no_run_failed(self):
        for end in (".html", ".csv", ".md"):
            with open(self.path("rotating_star" + end)) as file:
                text = file.read()
            self.assertNotIn("A run failed", text)
            self.assertGreater(len(text), 500)

    def test_what_was_done_is_not_done_again(self):
        size = os.path.getsize(self.path("scores.jsonl"))
        self.run_groups()
        self.assertEqual(os.path.getsize(self.path("scores.jsonl")), size)


if __name__ == "__main__":
    unittest.main(verbosity=2)
