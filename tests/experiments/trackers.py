# SPDX-License-Identifier: Apache-2.0
"""What is compared: this tracker with its constants, frame-based methods, and the true pose."""

import math
import os
import random
import re
import shutil
from dataclasses import dataclass

from programs import CTL, FRAME_BASED, digest_of_program, run


def moved(start, off_px, stream):
    """A model's start so far off, in a direction drawn for the stream, and by 0.1 rad."""
    path, at, pose = start.partition("@")
    if not at or not off_px:
        return start
    x_px, y_px, theta_rad, *rest = (float(v) for v in pose.split(","))
    draw = random.Random(f"{stream} {os.path.basename(path)}")
    direction = draw.uniform(0, 2 * math.pi)
    values = [x_px + off_px * math.cos(direction), y_px + off_px * math.sin(direction),
              theta_rad + draw.choice((-0.1, 0.1)), *rest]
    return path + "@" + ",".join(f"{v:.6f}" for v in values)


@dataclass(frozen=True)
class Pursuit:
    """pursuitctl track. `parameters`: (name, value) over the preset's."""
    label: str
    preset: str = "default"
    estimator: str = ""
    strategy: str = ""
    transform: str = ""  # instead of the one that the scene states
    parameters: tuple = ()
    start_off_px: float = 0
    searches: bool = False  # nothing is said of where the objects are

    def key(self):
        off = f" off {self.start_off_px}" if self.start_off_px else ""
        off += " searched" if self.searches else ""
        return f"pursuit {self.preset} {self.estimator} {self.strategy} {self.transform} " \
               f"{self.parameters}{off} {digest_of_program(CTL)}"

    def track(self, files, folder):
        """Writes poses.csv and returns its path and the seconds that it took."""
        config = os.path.join(folder, "tracker.textproto")
        with open(config, "w") as file:
            file.write(f'preset: "{self.preset}"\n')
            for name, value in self.parameters:
                file.write(f'parameter {{ name: "{name}" value: {value} }}\n')
        poses = os.path.join(folder, "poses.csv")
        arguments = [CTL, "track", "--config", config, "--events", files.events, "--poses", poses,
                     "--transform", self.transform or files.transform]
        if self.estimator:
            arguments += ["--estimator", self.estimator]
        if self.strategy:
            arguments += ["--strategy", self.strategy]
        stream = os.path.basename(os.path.dirname(files.events))
        for start in files.starts():
            given = start.partition("@")[0] if self.searches else start
            arguments += ["--model", moved(given, self.start_off_px, stream)]
        _, said = run(arguments)
        return poses, float(re.search(r"events in ([0-9.]+) s", said).group(1))


@dataclass(frozen=True)
class FrameBased:
    """tests/experiments/baselines: events accumulated into frames, registered to the model."""
    label: str
    method: str  # procrustes, icp
    window_us: int
    options: tuple = ()
    grey: bool = False  # frames of grey levels, from exposure measurements

    def key(self):
        return f"frame_based {self.method} {self.window_us} {self.options} {self.grey} " \
               f"{digest_of_program(FRAME_BASED)}"

    def track(self, files, folder):
        poses = os.path.join(folder, "poses.csv")
        events = files.events.replace(".dat", ".es") if self.grey else files.events
        arguments = [FRAME_BASED, "--events", events, "--poses", poses, "--method",
                     self.method, "--window-us", self.window_us, "--transform", files.transform]
        if self.grey:
            arguments += ["--grey-change", 0.15]
        arguments += self.options
        for start in files.starts():
            arguments += ["--model", start]
        _, said = run(arguments)
        return poses, float(re.search(r"in ([0-9.]+) s", said).group(1))


@dataclass(frozen=True)
class Truth:
    """The true pose itself: what the measures say of it."""
    label: str = "true pose"

    def key(self):
        return "truth"

    def track(self, files, folder):
        poses = os.path.join(folder, "poses.csv")
        shutil.copyfile(files.truth, poses)
        return poses, 0.0


OURS = Pursuit("default")
PAPER = Pursuit("paper's constants", preset="paper")
TRUTH = Truth()
