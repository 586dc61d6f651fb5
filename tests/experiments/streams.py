# SPDX-License-Identifier: Apache-2.0
"""Streams of events with exact truth: simulated scenes, and recorded ones of another simulator."""

import csv
import hashlib
import os
import shutil
import threading
from dataclasses import dataclass, field
from types import SimpleNamespace

from programs import CTL, DATA, SOURCE, digest_of_files, digest_of_simulator, run

# Turns that map a shape onto itself.
SYMMETRY = {"star": 5, "H": 2}

# From which second a scene is scored, and the half width of its slopes, s; 0: no speeds.
SCORED = {"star_": (0.1, 0), "disc_": (0.1, 0), "appear": (0, 0.1), "overtake": (0.3, 0.1),
          "full_occlusion": (0.3, 0.1), "street": (0.3, 0.1), "crossing": (0.3, 0.1)}


def scored_from(name):
    return next((v for k, v in SCORED.items() if name.startswith(k)), (0.2, 0.1))


@dataclass
class Files:
    """One stream on disk, and what a tracker is told about it."""
    events: str
    truth: str
    objects: list = field(default_factory=list)  # rows of start.csv
    models: dict = field(default_factory=dict)  # as given to the tracker
    true_models: dict = field(default_factory=dict)
    scored_from_s: float = 0.2
    speed_window_s: float = 0.1

    @property
    def transform(self):
        return self.objects[0]["transform"]

    def starts(self):
        """The models with their start poses, as pursuitctl takes them."""
        for row in self.objects:
            path = self.models[row["object"]]
            if row["mode"] == "search":
                yield path
            else:
                scale = "" if self.transform == "isometry" else "," + row["scale"]
                yield f"{path}@{row['x_px']},{row['y_px']},{row['theta_rad']}{scale}"


def read_folder(folder, models, name, transform=None):
    from_s, window_s = scored_from(name)
    files = Files(os.path.join(folder, "events.dat"), os.path.join(folder, "truth.csv"),
                  scored_from_s=from_s, speed_window_s=window_s)
    with open(os.path.join(models, "start.csv"), newline="") as file:
        files.objects = list(csv.DictReader(file))
    for row in files.objects:
        row.setdefault("transform", transform)
        path = os.path.join(models, f"model_{row['object']}.csv")
        true_path = os.path.join(models, f"model_true_{row['object']}.csv")
        files.models[row["object"]] = path
        files.true_models[row["object"]] = true_path if os.path.exists(true_path) else path
    return files


_locks = {}
_locks_lock = threading.Lock()


@dataclass(frozen=True)
class Simulated:
    """A built-in scene, one seed, and settings over it; `gaps`: (begin, end) s without events."""
    scene: str
    seed: int
    settings: tuple = ()
    gaps: tuple = ()

    @property
    def name(self):
        return self.scene

    def key(self):
        path = os.path.join(SOURCE, "services/sensor/scene/builtin",
                            self.scene + ".scene.textproto")
        of_scene = digest_of_files([path])
        return f"{self.scene} {self.seed} {self.settings} {self.gaps} {of_scene} " \
               f"{digest_of_simulator()}"

    def files(self, cache):
        """Makes the stream where `cache` does not have it yet."""
        folder = os.path.join(cache, hashlib.sha1(self.key().encode()).hexdigest()[:16])
        with _locks_lock:
            lock = _locks.setdefault(folder, threading.Lock())
        with lock:
            if not os.path.exists(folder):
                self._make(folder)
        return read_folder(folder, os.path.join(folder, "models"), self.scene)

    def _make(self, folder):
        unfinished = folder + ".unfinished"
        shutil.rmtree(unfinished, ignore_errors=True)
        os.makedirs(unfinished)
        events = os.path.join(unfinished, "events.dat")
        arguments = [CTL, "simulate", self.scene, "--seed", self.seed, "--events", events,
                     "--truth", os.path.join(unfinished, "truth.csv"),
                     "--models", os.path.join(unfinished, "models")]
        for setting in self.settings:
            arguments += ["--set", setting]
        run(arguments)
        if any(setting.startswith("sensor.exposure_us=") for setting in self.settings):
            # The same again in a format that holds exposure measurements.
            arguments[arguments.index(events)] = os.path.join(unfinished, "events.es")
            run(arguments)
        for begin_s, end_s in self.gaps:
            cut(events, begin_s, end_s)
        os.rename(unfinished, folder)


@dataclass(frozen=True)
class Recorded:
    """A folder of PURSUIT_TEST_DATA/simulated: made by another simulator."""
    folder: str

    @property
    def name(self):
        return self.folder

    def key(self):
        return f"recorded {self.folder}"

    def files(self, _):
        folder = os.path.join(DATA, "simulated", self.folder)
        transform = {"affine_H": "paper_affine", "affine_car_shear": "full_affine",
                     "appear": "similarity", "camera_outdoor": "similarity"}
        return read_folder(folder, folder, self.folder, transform.get(self.folder, "isometry"))


def read_dat(path):
    """Header bytes and the events of a DAT file as an array [n, 2] of 32-bit words: t_us, address."""
    import numpy as np
    with open(path, "rb") as file:
        content = file.read()
    begin = 0
    while content[begin:begin + 1] == b"%":
        begin = content.index(b"\n", begin) + 1
    begin += 2
    words = np.frombuffer(content[begin:len(content) - (len(content) - begin) % 8], "<u4")
    return content[:begin], words.reshape(-1, 2)


def cut(path, begin_s, end_s):
    """Takes the events of a stretch of time out of a DAT file."""
    header, words = read_dat(path)
    keep = (words[:, 0] < begin_s * 1e6) | (words[:, 0] >= end_s * 1e6)
    with open(path, "wb") as file:
        file.write(header)
        file.write(words[keep].tobytes())


def events_of(path):
    """t_us, x, y of a DAT file."""
    _, words = read_dat(path)
    return SimpleNamespace(t_us=words[:, 0].astype("i8"), x=(words[:, 1] & 0x3fff).astype(float),
                           y=((words[:, 1] >> 14) & 0x3fff).astype(float),
                           on=(words[:, 1] >> 28) & 1)
