# SPDX-License-Identifier: Apache-2.0
"""Real recordings with one set of constants: a car that passes an ATIS, and shapes before a DAVIS
that turns, with a reference for the motion of each."""

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


class Clip:
    """What the data set says of the shapes' motion: flow.npy, the way (px) of each pixel over the
    clip, at one angular velocity (motion.txt).

    Its image is not the pinhole of calib.txt: the code that made it takes out the distortion and
    maps to what OpenCV's getOptimalNewCameraMatrix (alpha 0) gives, the greatest image without
    empty corners.
    """

    def __init__(self, folder):
        self.folder = folder
        self.calibration = np.loadtxt(os.path.join(folder, "calib.txt"))
        self.flow = np.load(os.path.join(folder, "flow.npy"))[0]
        self.rotation_rad_s = np.loadtxt(os.path.join(folder, "motion.txt"))
        _, height, width = self.flow.shape
        # As OpenCV: from nine points a side, the rectangle inside.
        columns, rows = np.linspace(0, width - 1, 9), np.linspace(0, height - 1, 9)
        x, y = self.rays(np.array(np.meshgrid(columns, rows)))
        low = np.array([x[:, 0].max(), y[0].max()])
        high = np.array([x[:, -1].min(), y[-1].min()])
        self.focal = np.array([width - 1, height - 1]) / (high - low)
        self.centre = -self.focal * low

    def rays(self, p):
        """[2, …] of pixels [2, …]: where they look, x/z and y/z (fixed-point iteration)."""
        fx, fy, cx, cy, k1, k2, p1, p2, k3 = self.calibration
        distorted = np.array([(p[0] - cx) / fx, (p[1] - cy) / fy])
        q = distorted.copy()
        for _ in range(30):
            x, y = q
            r2 = x * x + y * y
            radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
            tangential = np.array([2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                                   p1 * (r2 + 2 * y * y) + 2 * p2 * x * y])
            q = (distorted - tangential) / radial
        return q

    def undistorted(self, p):
        """Where a pixel is in the image of the flow."""
        return self.rays(p) * self.focal + self.centre

    def flow_at(self, p):
        """The way over the clip at a place, px (bilinear)."""
        column, row = (int(v) for v in np.floor(p))
        right, below = p - (column, row)
        near = self.flow[:, row:row + 2, column:column + 2]
        return near @ np.array([1 - right, right]) @ np.array([1 - below, below])

    def moved(self, p, seconds):
        """Where what is at p is so much later."""
        steps = 20
        for _ in range(steps):
            p = p + self.flow_at(p) * (seconds / (SHAPES_END_S - SHAPES_BEGIN_S) / steps)
        return p

    def sharpest(self):
        """By how much the rotation must be scaled to align the clip's events best (greatest sum of
        squared smoothed counts), in the image of the flow and in that of calib.txt."""
        t, x, y, polarity = np.loadtxt(os.path.join(self.folder, "events.txt")).T
        rays = self.rays(np.array([x, y]))
        fx, fy, cx, cy = self.calibration[:4]
        wx, wy, wz = self.rotation_rad_s
        found = []
        for focal, centre in ((self.focal, self.centre), ((fx, fy), (cx, cy))):
            at = rays * np.reshape(focal, (2, 1)) + np.reshape(centre, (2, 1))
            u, v = at - np.array([[cx], [cy]])  # the flow is of calib.txt's focal length
            speed = np.array([u * v / fy * wx - (u * u / fx + fx) * wy + fx * v / fy * wz,
                              (v * v / fy + fy) * wx - u * v / fx * wy - fy * u / fx * wz])
            scales = np.arange(0.9, 1.3, 0.01)
            sums = []
            for scale in scales:
                column, row = at - scale * speed * (t - t.mean()) + 60
                ok = (column > 1) & (column < 358) & (row > 1) & (row < 298)
                image = np.zeros((2, 300, 360))
                c, r = np.floor(column[ok]).astype(int), np.floor(row[ok]).astype(int)
                right, below = column[ok] - c, row[ok] - r
                p = polarity[ok].astype(int)
                for dx, wide in ((0, 1 - right), (1, right)):
                    for dy, high in ((0, 1 - below), (1, below)):
                        np.add.at(image, (p, r + dy, c + dx), wide * high)
                for axis in (1, 1, 2, 2):  # a bell of sigma 1 px
                    image = (np.roll(image, 1, axis) + 2 * image + np.roll(image, -1, axis)) / 4
                sums.append((image ** 2).sum())
            found.append(float(scales[int(np.argmax(sums))]))
        return found


def shape(clip, name, transform, estimator):
    """The way of the shape's centre less what the flow says of it, px: from where the model was
    made of it, at the middle of its window, to the last pose; and from a pose 5 ms after it."""
    events = os.path.join(clip.folder, "events.txt")
    with tempfile.TemporaryDirectory() as work:
        model, origin = extract(events, SHAPES_BEGIN_S, SHAPES[name], 80, work, name)
        poses = track(events, SHAPES_BEGIN_S + WINDOW_S, SHAPES_END_S + 1, model, transform,
                      estimator, work)
    settled = poses[np.searchsorted(poses[:, 0], (SHAPES_BEGIN_S + WINDOW_S + 0.005) * 1e6)]
    last = poses[-1]
    off = []
    for t_s, p in ((SHAPES_BEGIN_S + WINDOW_S / 2, origin), (settled[0] * 1e-6, settled[1:3])):
        told = clip.moved(clip.undistorted(p), last[0] * 1e-6 - t_s)
        off.append(clip.undistorted(last[1:3]) - told)
    return off


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
    clip = Clip(os.path.join(DATA, "shapes_rotation"))
    in_flow, in_calibration = clip.sharpest()
    page.text("px between the way of the shape's centre and what the data set's flow makes of it, "
              "in the image of the flow; the way is 8 to 11 px. First from where the model was "
              "made, at the middle of its window, to the end: the flow is of one velocity for all "
              "of the clip, so that the more of the clip is compared, the better it is known. "
              "Beside it from a pose 5 ms after the window to the end, of which the flow is taken "
              "to have its share in time; and what is common to the shapes, of the first.")
    page.text(f"The flow's image has a focal length of {clip.focal[0]:.0f} by {clip.focal[1]:.0f} "
              f"px and not the {clip.calibration[0]:.0f} px of calib.txt: the events of the whole "
              f"clip, of all shapes, align best with {in_flow:.2f} times the given rotation there, "
              f"and with {in_calibration:.2f} times in the other; the last row says what the same "
              "poses would be off were it that one. So near to what the events themselves say, the "
              "rotation may have been fitted to them rather than measured by the gyroscope; it is "
              "independent of tracker and models either way. It cannot know that the camera slows "
              "down in the clip: events of single shapes, stacked over 12 ms, run up to 0.5 px "
              "ahead of it in the middle, and up to 0.3 px at the end.")
    other = Clip(clip.folder)
    other.focal, other.centre = clip.calibration[:2], clip.calibration[2:4]
    trackers = [(clip, estimator, transform, f"{estimator}, {transform}")
                for estimator in ("kalman", "gradient") for transform in ("isometry", "similarity")]
    trackers.append((other, "kalman", "isometry", "kalman, isometry, in the image of calib.txt"))
    rows = []
    for image, estimator, transform, title in trackers:
        off = {name: shape(image, name, transform, estimator) for name in SHAPES}
        common = np.mean([whole for whole, _ in off.values()], axis=0)
        rows.append([title] +
                    [" / ".join(number(float(np.hypot(*v))) for v in both)
                     for both in off.values()] +
                    [number(statistics.fmean(float(np.hypot(*w)) for w, _ in off.values())),
                     f"({common[0]:.2f}, {common[1]:.2f})"])
    page.table(["px, whole / later"] + list(SHAPES) + ["mean, whole", "common"], rows)
    return page
