# SPDX-License-Identifier: Apache-2.0
"""Real recordings with one set of constants: a car that passes an ATIS, and shapes before a DAVIS
whose camera motion a gyroscope measured."""

import csv
import math
import os
import re
import statistics
import tempfile

import numpy as np

from page import Page
from programs import CTL, DATA, run as run_program
from scores import number

CAR_STARTS_S = (1.56, 1.58, 1.60, 1.62, 1.64)
CAR_END_S = 2.2
SHAPES = {"star": (62, 30, 46, 46), "triangle": (38, 116, 42, 48), "hexagon": (120, 84, 38, 38)}
SHAPES_BEGIN_S, SHAPES_END_S = 2.097134, 2.195729
WINDOW_S = 0.02


def extract(events, at_s, roi, points, folder, name):
    """Path of a model made of a window of the recording, and where its origin was."""
    path = os.path.join(folder, name + ".model.textproto")
    run_program([CTL, "model", "extract", "--events", events, "--at", at_s, "--window",
                 WINDOW_S * 1e3, "--roi", ",".join(map(str, roi)), "--points", points, "--name",
                 name, "--output", path])
    with open(path) as file:
        text = file.read()
    return path, np.array([float(re.search(rf"origin_{axis}_px: ([-0-9.e]+)", text).group(1))
                           for axis in "xy"])


def track(events, from_s, to_s, model, transform, estimator, folder):
    """[n, 7]: t_us, T, A, every pose."""
    poses = os.path.join(folder, "poses.csv")
    run_program([CTL, "track", "--events", events, "--from", from_s, "--to", to_s, "--model",
                 model, "--transform", transform, "--estimator", estimator, "--poses", poses])
    with open(poses, newline="") as file:
        return np.array([[float(r[c]) for c in ("t_us", "x_px", "y_px", "a00", "a01", "a10", "a11")]
                         for r in csv.DictReader(file)])


def car(transform, estimator, points):
    """rms px from the reference point, one for each of the five models."""
    events = os.path.join(DATA, "car/car_atis_td.dat")
    with open(os.path.join(DATA, "car/reference_pose_20ms.csv")) as file:
        reference = np.array([[float(v) for v in line.split(",")[:3]]
                              for line in file if not line.startswith("#")])
    off = []
    for start_s in CAR_STARTS_S:
        middle = np.array([np.interp(start_s + WINDOW_S / 2, reference[:, 0], reference[:, i])
                           for i in (1, 2)])
        # The car reaches from 50 px behind the reference point to 88 px before it.
        roi = (max(0, int(middle[0]) - 60), int(middle[1]) - 26, 155, 52)
        with tempfile.TemporaryDirectory() as folder:
            model, origin = extract(events, start_s, roi, points, folder, "car")
            poses = track(events, start_s + WINDOW_S, CAR_END_S, model, transform, estimator,
                          folder)
        squares = []
        for t_s, x, y in reference[:, :3]:
            before = np.searchsorted(poses[:, 0], t_s * 1e6, "right") - 1
            if not start_s + WINDOW_S <= t_s <= CAR_END_S or before < 0:
                continue
            p = poses[before]
            at = p[1:3] + p[3:].reshape(2, 2) @ (middle - origin)
            squares.append((at[0] - x) ** 2 + (at[1] - y) ** 2)
        off.append(math.sqrt(statistics.fmean(squares)))
    return off


def undistorted(p, calibration):
    """Pixel of a pinhole camera without distortion (fixed-point iteration)."""
    fx, fy, cx, cy, k1, k2, p1, p2, k3 = calibration
    distorted = np.array([(p[0] - cx) / fx, (p[1] - cy) / fy])
    q = distorted.copy()
    for _ in range(30):
        x, y = q
        r2 = x * x + y * y
        radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
        tangential = np.array([2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                               p1 * (r2 + 2 * y * y) + 2 * p2 * x * y])
        q = (distorted - tangential) / radial
    return np.array([q[0] * fx + cx, q[1] * fy + cy])


def shape(name, transform, estimator):
    """The way of the shape's centre less what the gyroscope says of it, px."""
    folder = os.path.join(DATA, "shapes_rotation")
    events = os.path.join(folder, "events.txt")
    calibration = np.loadtxt(os.path.join(folder, "calib.txt"))
    flow = np.load(os.path.join(folder, "flow.npy"))[0]
    with tempfile.TemporaryDirectory() as work:
        model, _ = extract(events, SHAPES_BEGIN_S, SHAPES[name], 80, work, name)
        poses = track(events, SHAPES_BEGIN_S + WINDOW_S, SHAPES_END_S + 1, model, transform,
                      estimator, work)
    # The first pose is where the model was made; the track has settled 5 ms later.
    first = poses[np.searchsorted(poses[:, 0], (SHAPES_BEGIN_S + WINDOW_S + 0.005) * 1e6)]
    last = poses[-1]
    begin, end = (undistorted(p[1:3], calibration) for p in (first, last))
    share = (last[0] - first[0]) * 1e-6 / (SHAPES_END_S - SHAPES_BEGIN_S)
    x, y = (int(round(v)) for v in begin)
    return end - begin - share * flow[:, y, x]


def run(_):
    page = Page("recorded", "Real recordings")
    if not os.path.isdir(os.path.join(DATA, "car")):
        page.text(f"No recordings under PURSUIT_TEST_DATA={DATA}.")
        return page
    page.heading("A car passes an ATIS")
    page.text("rms px between the car's reference point, as frames of 20 ms were registered, and "
              "where the pose takes it: five models, made at 1.56 … 1.64 s, each followed to "
              "2.2 s.")
    rows = []
    for estimator in ("kalman", "gradient"):
        for transform in ("similarity", "paper_affine", "full_affine"):
            for points in (300, 400):
                off = car(transform, estimator, points)
                rows.append([f"{estimator}, {transform}, {points} points",
                             number(statistics.median(off)), number(max(off)),
                             " ".join(number(v) for v in off)])
    page.table(["", "median", "worst", "each"], rows)
    page.heading("Shapes before a DAVIS")
    page.text("px between the way of the shape's centre over 74 ms and what the gyroscope's "
              "rotation makes of it, in the undistorted image; the way is 9 to 12 px. Beside it how "
              "far each is from the mean over the three shapes: what is common to all of them "
              "may be the camera's own shift, which a gyroscope does not see.")
    rows = []
    for estimator in ("kalman", "gradient"):
        for transform in ("isometry", "similarity"):
            off = {name: shape(name, transform, estimator) for name in SHAPES}
            common = np.mean(list(off.values()), axis=0)
            rows.append([f"{estimator}, {transform}"] +
                        [f"{number(float(np.hypot(*v)))} / {number(float(np.hypot(*(v - common))))}"
                         for v in off.values()] + [f"({common[0]:.2f}, {common[1]:.2f})"])
    page.table(["px / px from the mean"] + list(SHAPES) + ["common"], rows)
    return page
