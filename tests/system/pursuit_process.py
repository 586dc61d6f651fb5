# SPDX-License-Identifier: Apache-2.0
"""Real processes for tests: a DDS domain of one's own, start and stop by pid, systemd's READY.

The programs come from the folder in PURSUIT_BIN. Everything binds to loopback only.
"""

import fcntl
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

BIN = os.environ.get("PURSUIT_BIN", os.path.join(os.path.dirname(__file__), "../../build/release/bin"))
DATA = os.environ.get("PURSUIT_TEST_DATA",
                      os.path.join(os.path.dirname(__file__), "../../../shared/data"))


def program(name):
    return os.path.join(BIN, name)


def data(path):
    """A shared recording; the test is skipped, in plain words, where it is not there."""
    full = os.path.join(DATA, path)
    if not os.path.exists(full):
        raise unittest.SkipTest(f"recording {path} not found under PURSUIT_TEST_DATA={DATA}")
    return full


class FreeDomain:
    """A DDS domain that no other test of this host uses meanwhile: the lock of free_domain.hpp."""

    def __init__(self):
        for self.domain in range(20, 100):
            path = os.path.join(tempfile.gettempdir(), f"pursuit-domain-{self.domain}.lock")
            self.file = open(path, "a")
            try:
                fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                return
            except OSError:
                self.file.close()
        raise RuntimeError("no free DDS domain")

    def close(self):
        self.file.close()


class Process:
    """One program; its standard output and error go to files."""

    def __init__(self, name, arguments, folder, ready=True, environment=None):
        self.name = name
        stem = os.path.join(folder, f"{os.path.basename(name)}-{time.monotonic_ns()}")
        self.out_path, self.err_path = stem + ".out", stem + ".err"
        environment = {**os.environ, **(environment or {})}
        self.notify = None
        if ready:
            self.notify = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
            self.notify.bind(stem + ".notify")
            self.notify.settimeout(0.1)
            environment["NOTIFY_SOCKET"] = stem + ".notify"
        with open(self.out_path, "wb") as out, open(self.err_path, "wb") as err:
            path = name if os.path.sep in name else program(name)
            self.started = time.monotonic()
            self.process = subprocess.Popen([path] + [str(a) for a in arguments], stdout=out,
                                            stderr=err, stdin=subprocess.DEVNULL, env=environment)
        if ready:
            self.wait_ready()

    def wait_ready(self):
        while True:
            try:
                message = self.notify.recv(4096)
            except socket.timeout:
                if not self.alive() or time.monotonic() - self.started > 10:
                    raise AssertionError(f"{self.name} is not READY: {self.err()}")
                continue
            if b"READY=1" in message:
                break
        self.ready_after = time.monotonic() - self.started
        # Nobody reads on: closing makes the later notifications fail at once instead of filling up.
        self.notify.close()

    def wait(self, timeout=60):
        try:
            return self.process.wait(timeout)
        except subprocess.TimeoutExpired:
            self.kill()
            raise AssertionError(f"{self.name} did not end within {timeout} s: {self.err()[-2000:]}")

    def stop(self, timeout=5):
        """SIGTERM; gives the exit code and how long it took in self.stop_s."""
        begin = time.monotonic()
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        code = self.wait(timeout)
        self.stop_s = time.monotonic() - begin
        return code

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait(5)

    def alive(self):
        return self.process.poll() is None

    def out(self):
        with open(self.out_path, errors="replace") as file:
            return file.read()

    def err(self):
        with open(self.err_path, errors="replace") as file:
            return file.read()


class SystemTest(unittest.TestCase):
    """A test with a domain and a folder of its own; ends what it started."""

    def setUp(self):
        self.domain = FreeDomain()
        self.folder = tempfile.mkdtemp(prefix="pursuit-test-")
        self.processes = []

    def tearDown(self):
        for process in self.processes:
            process.kill()
        self.domain.close()
        if self._outcome_is_good():
            subprocess.run(["rm", "-rf", self.folder], check=True)
        else:
            sys.stderr.write(f"\nwhat the processes said is kept in {self.folder}\n")

    def _outcome_is_good(self):
        result = getattr(self._outcome, "result", None)
        return result is not None and not any(
            test is self and text for test, text in result.failures + result.errors)

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self, name, *arguments, ready=True, environment=None):
        process = Process(name, arguments, self.folder, ready, environment)
        self.processes.append(process)
        return process

    def service(self, name, /, **fields):
        """A service with --set field=value; a list gives the field several times."""
        arguments = []
        fields = {"dds.domain": self.domain.domain, "dds.loopback_only": "true", **fields}
        for field, values in fields.items():
            for value in values if isinstance(values, list) else [values]:
                if isinstance(value, bool):
                    value = "true" if value else "false"
                arguments += ["--set", f"{field}={value}"]
        return self.start("pursuit-" + name, *arguments)

    def ctl_arguments(self, *arguments):
        return [*arguments, "--domain", self.domain.domain, "--loopback"]

    def ctl(self, *arguments, code=0, timeout=30, dds=True):
        """pursuitctl to its end; checks the exit code and gives standard output."""
        arguments = self.ctl_arguments(*arguments) if dds else list(arguments)
        done = subprocess.run([program("pursuitctl")] + [str(a) for a in arguments],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              stdin=subprocess.DEVNULL, timeout=timeout, text=True)
        self.ctl_err = done.stderr
        self.assertEqual(done.returncode, code,
                         f"pursuitctl {' '.join(map(str, arguments))}: {done.stdout}{done.stderr}")
        return done.stdout

    def status_of(self, kind, name=None):
        """The status of a service that is there: of the only one of its kind, or by its name."""
        def found():
            status = json.loads(self.ctl("status", "--json"))
            return status[kind] if name is None else status[kind + "s"].get(name)
        return self.eventually(found, what=f"a {kind} tells its status")

    def eventually(self, condition, timeout=10, what="the condition"):
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            value = condition()
            if value:
                return value
            time.sleep(0.02)
        self.fail(f"{what} did not come true within {timeout} s")
