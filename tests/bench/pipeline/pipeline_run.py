# SPDX-License-Identifier: Apache-2.0
"""One stream of events through the real processes, in a DDS domain of its own on loopback."""

import csv
import json
import os
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../system"))
from pursuit_process import BIN, FreeDomain, Process, program  # noqa: E402

TOOLS = os.path.join(BIN, "../bench/pipeline")
TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def tool(name):
    return os.path.join(TOOLS, name)


def rows(path):
    """A CSV file of numbers and names, as a list of dictionaries."""
    with open(path, newline="") as file:
        return [{key: float(value) if "." in value else int(value) for key, value in row.items()}
                for row in csv.DictReader(file)]


def busy_s():
    """How long all processors together have been busy since the start of the machine."""
    with open("/proc/stat") as file:
        user, nice, system, _idle, _wait, irq, softirq, steal = map(int, file.readline().split()[1:9])
    return (user + nice + system + irq + softirq + steal) / TICKS_PER_S


def cpu_s(process):
    """Processor time of a process that runs, all its threads."""
    with open(f"/proc/{process.process.pid}/stat") as file:
        fields = file.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS_PER_S


def until(condition, at_most_s, what):
    end = time.monotonic() + at_most_s
    while not condition():
        if time.monotonic() > end:
            raise RuntimeError(f"{what} did not come true within {at_most_s} s")
        time.sleep(0.02)


class Stream:
    """Events of one rate in a folder, and how to register what moves in them."""

    def __init__(self, folder, rate_hz, seconds):
        self.folder, self.rate_hz, self.seconds = folder, rate_hz, seconds
        made = subprocess.run([tool("make_events"), str(rate_hz), str(seconds), folder], check=True,
                              stdout=subprocess.PIPE, text=True)
        self.events = os.path.join(folder, "events.dat")
        self.count = int(rate_hz * seconds)
        self.models = made.stdout.split()

    def truth(self):
        """By time and object id (in order of registration): where the object is, px."""
        with open(os.path.join(self.folder, "truth.csv"), newline="") as file:
            names = {"left": 1, "right": 2}
            return {(int(row["t_us"]), names[row["model"]]): (float(row["x_px"]), float(row["y_px"]))
                    for row in csv.DictReader(file)}


class Pipeline:
    """Sensor, tracker and an observer of the poses; with `packets` another of what is between."""

    def __init__(self, folder, packets=False):
        self.folder, self.packets = folder, packets
        self.domain = FreeDomain()
        self.running = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.running:
            process.kill()
        self.domain.close()

    def start(self, name, *arguments, ready=False):
        process = Process(name, arguments, self.folder, ready)
        self.running.append(process)
        return process

    def service(self, name, **fields):
        fields = {"dds.domain": self.domain.domain, "dds.loopback_only": "true", **fields}
        arguments = []
        for field, value in fields.items():
            arguments += ["--set", f"{field}={value}"]
        return self.start("pursuit-" + name, *arguments, ready=True)

    def ctl(self, *arguments):
        return subprocess.run([program("pursuitctl"), *arguments, "--domain",
                               str(self.domain.domain), "--loopback"], check=True, text=True,
                              stdout=subprocess.PIPE, stdin=subprocess.DEVNULL).stdout

    def observer(self, what):
        path = os.path.join(self.folder, what + ".csv")
        return self.start(tool("observer"), self.domain.domain, what, path), path

    def run(self, stream, estimator, sensor_fields=None, tracker_fields=None):
        """Everything that is known of one pass of the stream."""
        tracker = self.service("tracker", **(tracker_fields or {}))
        for model in stream.models:
            self.ctl("model", "register", model, "--estimator", estimator)
        poses, poses_path = self.observer("poses")
        until(lambda: "matched" in poses.out(), 10, "the observer hears the tracker")
        readers = 1
        if self.packets:
            packets, packets_path = self.observer("packets")
            readers = 2
        busy_before_s, began = busy_s(), time.monotonic()
        tracker_before_s = cpu_s(tracker)
        sensor = self.service("sensor", recording=stream.events, wait_for_subscribers=readers,
                              exit_at_end="false", **(sensor_fields or {}))
        sensor_before_s = cpu_s(sensor)
        # Nothing is asked of anybody while the stream is under way.
        time.sleep(stream.seconds + 0.3)
        status = self.wait_for_end()
        result = {"estimator": estimator, "events": stream.count,
                  "sensor": status["sensor"], "tracker": status["tracker"],
                  "sensor_cpu_s": cpu_s(sensor) - sensor_before_s,
                  "tracker_cpu_s": cpu_s(tracker) - tracker_before_s,
                  "elapsed_s": time.monotonic() - began}
        ours_s = result["sensor_cpu_s"] + result["tracker_cpu_s"] + cpu_s(poses)
        if self.packets:
            ours_s += cpu_s(packets)
        # What shares the processors, as processors: 0 is a machine of our own.
        result["others"] = max(0, busy_s() - busy_before_s - ours_s) / result["elapsed_s"]
        for process in self.running:
            if process.stop() != 0:
                raise RuntimeError(f"{process.name} failed: {process.err()[-2000:]}")
        result["poses"] = rows(poses_path)
        result["packets"] = rows(packets_path) if self.packets else []
        return result

    def wait_for_end(self):
        """Until the sensor has sent all, and the tracker works on nothing any more."""
        before = -1
        end = time.monotonic() + 120
        while time.monotonic() < end:
            status = json.loads(self.ctl("status", "--json"))
            if status["sensor"] is None or status["tracker"] is None:
                continue  # not heard in time, on a busy machine
            done = status["tracker"]["events_in"]
            if status["sensor"]["state"] == "FINISHED" and done == before:
                return status
            before = done
            # A status is told once a second.
            time.sleep(1.1)
        raise RuntimeError("the stream does not come to its end within 120 s")


def lost_events(result):
    """Events of the stream that the tracker did not work on, for whatever cause."""
    tracker = result["tracker"]
    return result["events"] - (tracker["events_in"] - tracker["events_dropped"])


def bare_hop_ns(folder, words, period_us, count):
    """How long each packet of a size took from one process to another with nothing else to do."""
    domain = FreeDomain()
    path = os.path.join(folder, "hop.csv")
    receiver = Process(tool("observer"), [domain.domain, "packets", path], folder, ready=False)
    try:
        subprocess.run([tool("bare_writer"), str(domain.domain), str(words), str(period_us),
                        str(count)], check=True, stdin=subprocess.DEVNULL)
        if receiver.stop() != 0:
            raise RuntimeError(receiver.err())
    finally:
        receiver.kill()
        domain.close()
    return [row["received_ns"] - row["host_time_ns"] for row in rows(path)]
