#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Each folder of the tracking core uses those above it alone (docs/tracking.md, "In the sources")."""

import os
import re
import sys
import unittest

CORE = "services/tracker/core"
SOURCE = sys.argv.pop(1)
# What all share; the other files at the top span all objects, and no folder uses them.
SHARED = {"call_result", "clamped", "kinds", "parameters", "pose_record", "registration"}


def folders_in_order():
    with open(os.path.join(SOURCE, "docs/tracking.md"), encoding="utf-8") as file:
        section = file.read().partition("## In the sources")[2]
    return re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE)


def included_by(folder):
    for name in sorted(os.listdir(os.path.join(SOURCE, CORE, folder))):
        with open(os.path.join(SOURCE, CORE, folder, name), encoding="utf-8") as file:
            for path in re.findall(rf'#include "{CORE}/([\w/]+)\.hpp"', file.read()):
                yield name, path


class Folders(unittest.TestCase):
    def test_are_all_in_the_documents(self):
        core = os.path.join(SOURCE, CORE)
        there = [name for name in os.listdir(core) if os.path.isdir(os.path.join(core, name))]
        self.assertEqual(sorted(folders_in_order()), sorted(there))

    def test_use_what_all_share_and_the_folders_above_alone(self):
        above = set()
        uses = 0
        for folder in folders_in_order():
            above.add(folder)
            for name, path in included_by(folder):
                uses += 1
                used, _, file = path.rpartition("/")
                with self.subTest(f"{folder}/{name} includes {path}"):
                    self.assertTrue(used in above if used else file in SHARED)
        self.assertGreater(uses, 100)


if __name__ == "__main__":
    unittest.main()
