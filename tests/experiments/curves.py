# SPDX-License-Identifier: Apache-2.0
"""What tables of poses look like over time. Numbers are cut to what a plot needs."""

import csv

import numpy as np

from streams import events_of

POSE = ("x_px", "y_px", "a00", "a01", "a10", "a11")


def rows_of(path, name):
    """t_us [n] and pose [n, 6] of one object, every row of the table."""
    times, poses = [], []
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            if row["model"] == name:
                times.append(int(row["t_us"]))
                poses.append([float(row[c]) for c in POSE])
    return np.array(times, "i8"), np.array(poses, float).reshape(-1, 6)


def column_of(path, name, column):
    with open(path, newline="") as file:
        return np.array([float(r[column]) for r in csv.DictReader(file) if r["model"] == name])


def model_points(path):
    return np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)


def placed(pose, points):
    return pose[:2] + points @ pose[2:].reshape(2, 2).T


def held_at(times, poses, t_us):
    """The last pose at or before each time; the first one before it."""
    return poses[np.clip(np.searchsorted(times, t_us, "right") - 1, 0, len(times) - 1)]


def errors(files, poses_path, name):
    """t_us, E px at every row of the truth."""
    t_us, truth = rows_of(files.truth, name)
    times, poses = rows_of(poses_path, name)
    if not len(times):
        return t_us, np.full(len(t_us), np.nan)
    points = model_points(files.true_models[name])
    off = held_at(times, poses, t_us) - truth
    a = off[:, 2:].reshape(-1, 2, 2)
    way = off[:, None, :2] + points[None] @ a.transpose(0, 2, 1)
    return t_us, np.sqrt((way ** 2).sum(2).mean(1))


def thinned(t_us, values, at_most=400):
    """[seconds], [values], for a plot; not-a-number as None."""
    step = max(1, len(t_us) // at_most)
    return ([round(float(t) * 1e-6, 5) for t in t_us[::step]],
            [None if not np.isfinite(v) else round(float(v), 4) for v in values[::step]])


def error_curve(files, poses_path):
    """{object: (seconds, E px)}."""
    return {o["object"]: thinned(*errors(files, poses_path, o["object"])) for o in files.objects}


def pose_curve(files, poses_path):
    """{object: (seconds, [x, y, theta])} of the tracker, held."""
    out = {}
    for row in files.objects:
        t_us, _ = rows_of(files.truth, row["object"])
        times, poses = rows_of(poses_path, row["object"])
        if not len(times):
            continue
        p = held_at(times, poses, t_us)
        theta = np.unwrap(np.arctan2(p[:, 4] - p[:, 3], p[:, 2] + p[:, 5]))
        out[row["object"]] = [thinned(t_us, v) for v in (p[:, 0], p[:, 1], theta)]
    return out


def speed_curve(files, poses_path, window_s=0.1):
    """{object: (seconds, px/s)}: least-squares slopes over ± window_s of the held poses."""
    out = {}
    for row in files.objects:
        t_us, _ = rows_of(files.truth, row["object"])
        times, poses = rows_of(poses_path, row["object"])
        if not len(times):
            continue
        p = held_at(times, poses, t_us)
        w = int(window_s * 1000)
        u = np.arange(-w, w + 1) * 1e-3
        kernel = (u / (u ** 2).sum())[::-1]
        v = np.hypot(np.convolve(p[:, 0], kernel, "valid"), np.convolve(p[:, 1], kernel, "valid"))
        out[row["object"]] = thinned(t_us[w:len(t_us) - w], v)
    return out


def event_distances(files, poses_path, reach_px=10, bins=50, at_most=200_000):
    """{object: [share of events by distance to the nearest model point]}, 0 … reach_px."""
    events = events_of(files.events)
    out = {}
    for row in files.objects:
        times, poses = rows_of(poses_path, row["object"])
        if not len(times):
            continue
        points = model_points(files.models[row["object"]])
        step = max(1, len(events.t_us) // at_most)
        t, x, y = events.t_us[::step], events.x[::step], events.y[::step]
        p = held_at(times, poses, t)
        best = np.full(len(t), np.inf)
        for mx, my in points:
            dx = x - p[:, 0] - p[:, 2] * mx - p[:, 3] * my
            dy = y - p[:, 1] - p[:, 4] * mx - p[:, 5] * my
            np.minimum(best, dx * dx + dy * dy, out=best)
        counts, _ = np.histogram(np.sqrt(best), bins, (0, reach_px))
        out[row["object"]] = [round(float(c), 5) for c in counts / max(1, len(t))]
    return out


def outlines_at(files, poses_path, t_s):
    """{object: [[x, y] …]} of the model as placed at a time, along its contour edges."""
    out = {}
    for row in files.objects:
        times, poses = rows_of(poses_path, row["object"])
        if not len(times):
            continue
        points = model_points(files.models[row["object"]])
        p = placed(held_at(times, poses, np.array([t_s * 1e6]))[0], points)
        edges = np.loadtxt(files.models[row["object"]].replace(".csv", "_edges.csv"),
                           delimiter=",", skiprows=1, dtype=int, ndmin=2)
        out[row["object"]] = [[[round(float(v), 2) for v in p[i]] for i in edge] for edge in edges]
    return out


def pixels_at(files, t_s, window_s=0.02):
    """{(x, y): colour} of the events around a time."""
    events = events_of(files.events)
    keep = np.abs(events.t_us - t_s * 1e6) < window_s * 5e5
    return {(int(x), int(y)): "#b5cfe8" if on else "#d9c2b0"
            for x, y, on in zip(events.x[keep], events.y[keep], events.on[keep])}


def perspective_fit(files, poses_path):
    """{object: [mean px of the best affine fit, mean px of the tracker]} against the true view,
    over the scored time: the fit is least squares, so that both ways are at right angles."""
    out = {}
    for row in files.objects:
        t_us, e = errors(files, poses_path, row["object"])
        fit = column_of(files.truth, row["object"], "fit_px")
        scored = t_us >= files.scored_from_s * 1e6
        out[row["object"]] = [float(fit[scored].mean()),
                              float(np.sqrt(e ** 2 + fit ** 2)[scored].mean())]
    return out


def event_rates(files, poses_path, near_px=3, bin_s=0.05):
    """{object: (seconds, events/s)}: of events within near_px of its points."""
    events = events_of(files.events)
    out = {}
    for row in files.objects:
        times, poses = rows_of(poses_path, row["object"])
        if not len(times):
            continue
        points = model_points(files.models[row["object"]])
        p = held_at(times, poses, events.t_us)
        near = np.zeros(len(events.t_us), bool)
        for mx, my in points:
            dx = events.x - p[:, 0] - p[:, 2] * mx - p[:, 3] * my
            dy = events.y - p[:, 1] - p[:, 4] * mx - p[:, 5] * my
            near |= dx * dx + dy * dy < near_px ** 2
        counts = np.bincount((events.t_us[near] // int(bin_s * 1e6)).astype(int))
        out[row["object"]] = ([round((i + 0.5) * bin_s, 4) for i in range(len(counts))],
                              [float(c) / bin_s for c in counts])
    return out
