#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A program of another DDS vendor, built from the same IDL, registers a model and gets its poses."""

import csv
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../system"))
from pursuit_process import SystemTest  # noqa: E402

LOOPBACK = """<CycloneDDS><Domain id="any">
  <General><Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces>
    <AllowMulticast>false</AllowMulticast></General>
  <Discovery><ParticipantIndex>auto</ParticipantIndex>
    <MaxAutoParticipantIndex>40</MaxAutoParticipantIndex>
    <Peers><Peer address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>"""


class Cyclone(SystemTest):
    def test_a_cyclone_dds_program_registers_a_model_and_receives_its_poses(self):
        self.ctl("simulate", "star_670rpm", "--seed", 2, "--truth", self.path("truth.csv"),
                 "--models", self.path("models"), dds=False, timeout=120)
        with open(self.path("models/start.csv"), newline="") as file:
            start = next(csv.DictReader(file))
        self.service("tracker")
        client = os.path.join(os.environ["PURSUIT_TESTS"], "cyclone_client")
        cyclone = self.start(client, self.domain.domain, self.path("models/model_star.csv"),
                             "star", start["x_px"], start["y_px"], start["theta_rad"], 500, 20,
                             ready=False, environment={"CYCLONEDDS_URI": LOOPBACK})
        self.eventually(lambda: "star" in self.ctl("model", "list"), what="the registration")
        printing = self.start(os.path.join(os.environ["PURSUIT_TESTS"], "print_poses"),
                              self.domain.domain, 300, 20, ready=False,
                              environment={"CYCLONEDDS_URI": LOOPBACK})
        self.service("sensor", scene="star_670rpm", seed=2, wait_for_subscribers=1)
        self.assertEqual(cyclone.wait(30), 0, cyclone.out() + cyclone.err())
        print(cyclone.out())
        self.assertIn("register: code 0", cyclone.out())
        self.assertIn("state 1", cyclone.out())
        self.assertEqual(printing.wait(30), 0, printing.out()[-500:] + printing.err())
        self.assertIn("us  star  TRACKING  confidence", printing.out())

    def test_a_cyclone_dds_program_that_asks_once_is_answered_by_a_tracker_that_answered_before(self):
        self.service("tracker")
        self.ctl("model", "list")  # so that there are replies which the next client has missed
        client = os.path.join(os.environ["PURSUIT_TESTS"], "cyclone_once")
        for _ in range(15):
            asking = self.start(client, self.domain.domain, ready=False,
                                environment={"CYCLONEDDS_URI": LOOPBACK})
            self.assertEqual(asking.wait(30), 0, asking.err())


if __name__ == "__main__":
    unittest.main(verbosity=2)
