#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What every service does for systemd and the shell: signals, and the watchdog."""

import ctypes
import os
import signal
import socket
import time
import unittest

from pursuit_process import SystemTest, program

PTRACE_DETACH, PTRACE_SEIZE, PTRACE_INTERRUPT = 17, 0x4206, 0x4207


def ptrace(request, thread):
    """Linux's ptrace(2); tells whether it was done."""
    call = ctypes.CDLL(None, use_errno=True).ptrace
    call.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
    return call(request, thread, None, None) == 0


def thread_of(process, name):
    """The id of the thread of that name."""
    tasks = f"/proc/{process.process.pid}/task"
    for thread in os.listdir(tasks):
        with open(f"{tasks}/{thread}/comm") as file:
            if file.read().strip() == name:
                return int(thread)
    raise AssertionError(f"{process.name} has no thread {name}")


class ServiceMain(SystemTest):
    def test_sighup_stops_each_service_in_order(self):
        for name, fields in (("tracker", {}), ("recorder", {"output": self.path("run.mcap")}),
                             ("sensor", {"scene": "overtake", "wait_for_subscribers": 5})):
            service = self.service(name, **fields)
            service.process.send_signal(signal.SIGHUP)
            self.assertEqual(service.wait(5), 0, service.err())
            self.assertIn("stops on SIGHUP", service.err())
        self.ctl("info", self.path("run.mcap"), dds=False)  # closed in order

    def test_a_service_started_by_nohup_outlives_the_terminal(self):
        tracker = self.start("/usr/bin/nohup", program("pursuit-tracker"),
                             "--set", f"dds.domain={self.domain.domain}",
                             "--set", "dds.loopback_only=true")
        tracker.process.send_signal(signal.SIGHUP)
        time.sleep(0.5)
        self.assertTrue(tracker.alive(), tracker.err())
        self.assertEqual(tracker.stop(), 0)
        self.assertIn("stops on SIGTERM", tracker.err())

    def hear(self, path):
        """What a service says to systemd from now on."""
        heard = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        heard.bind(path)
        heard.settimeout(0.1)
        self.addCleanup(heard.close)
        return heard

    def pings(self, heard, seconds):
        """How often the watchdog is told within so long from now that all is well."""
        heard.setblocking(False)
        try:
            while heard.recv(4096):
                pass
        except BlockingIOError:
            heard.settimeout(0.1)
        count, end = 0, time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                count += heard.recv(4096) == b"WATCHDOG=1"
            except socket.timeout:
                pass
        return count

    def test_the_watchdog_is_told_nothing_while_the_trackers_core_thread_is_halted(self):
        heard = self.hear(self.path("notify"))
        tracker = self.start("pursuit-tracker", "--set", f"dds.domain={self.domain.domain}",
                             "--set", "dds.loopback_only=true", ready=False,
                             environment={"NOTIFY_SOCKET": self.path("notify")})
        self.eventually(lambda: "ready" in tracker.err(), what="the tracker is ready")
        self.assertGreater(self.pings(heard, 1), 10)
        core = thread_of(tracker, "core")
        if not (ptrace(PTRACE_SEIZE, core) and ptrace(PTRACE_INTERRUPT, core)):
            self.skipTest("this host does not let a test halt a thread (ptrace)")
        self.pings(heard, 7)
        self.assertEqual(self.pings(heard, 1), 0)
        self.assertIn("the core thread has done nothing for 5 s", tracker.err())
        status = self.status_of("tracker")
        self.assertEqual(status["state"], "FAULT")
        self.assertTrue(ptrace(PTRACE_DETACH, core))
        self.eventually(lambda: self.pings(heard, 0.5) > 5, what="the watchdog is told again")
        self.assertIn("gets on again", tracker.err())


if __name__ == "__main__":
    unittest.main(verbosity=2)
