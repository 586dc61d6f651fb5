# SPDX-License-Identifier: Apache-2.0
"""What the times on poses and packets tell about the way of an event."""

import bisect

TRACKING = 1

# Up to here a stream has begun: the tracker lays out its models at the first event, and what came
# meanwhile is caught up with.
SETTLED_US = 1_000_000


def percentile(values, share):
    """The smallest value that at least the given share of the values does not exceed."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def fresh_poses(poses):
    """Those that events have moved since the pose before of the same object, with how many and
    since when (us of the pose before)."""
    before = {}
    fresh = []
    for pose in poses:
        last = before.get(pose["object_id"])
        before[pose["object_id"]] = pose
        if last is not None and pose["events_used"] > last["events_used"]:
            fresh.append((pose, pose["events_used"] - last["events_used"], last["t_us"]))
    return fresh


def paced_ns(pose, t_us):
    """When an event of that time was due, by the clock that paced it (real time)."""
    return pose["host_time_ns"] - (pose["t_us"] - t_us) * 1000


def settled(poses):
    return [pose for pose in poses if pose["t_us"] >= SETTLED_US]


def newest_event_ns(poses):
    """Of each pose: from the instant of the newest event in it to its reception."""
    return [pose["received_ns"] - paced_ns(pose, pose["last_event_t_us"])
            for pose, _, _ in fresh_poses(poses)]


def start_up_ns(poses):
    """The longest that a pose took before the stream had settled."""
    return max(newest_event_ns([pose for pose in poses if pose["t_us"] < SETTLED_US]))


def every_event_ns(poses):
    """Of the events (ten for each pose, spread over those that it is the first to know): from the
    instant of the event to the reception of that pose."""
    parts = 10
    return [pose["received_ns"] - paced_ns(pose, since_us + (pose["t_us"] - since_us) * (i + 0.5) / parts)
            for pose, _, since_us in fresh_poses(poses) for i in range(parts)]


def stages_ns(poses, packets, packet_us, packet_events):
    """Of each pose, how long its newest event was where. A pose of a grid time leaves the tracker
    when the first packet with an event at or after it comes."""
    last_us = [packet["last_t_us"] for packet in packets]
    stages = {"waits for its packet to be complete": [], "sensor: wakes up and packs": [],
              "a packet's hop, as another process receives it": [],
              "the packet's hop, queue and tracker": [], "the pose's hop": []}
    for pose, _, _ in fresh_poses(poses):
        at = bisect.bisect_left(last_us, pose["t_us"])
        if at == len(packets):
            continue
        packet = packets[at]
        full = packet["events"] >= packet_events
        length_us = packet["last_t_us"] - packet["base_time_us"] if full else packet_us
        due_ns = packet["host_time_ns"] + length_us * 1000
        for stage, ns in zip(stages.values(), (
                due_ns - paced_ns(pose, pose["last_event_t_us"]), packet["written_ns"] - due_ns,
                packet["received_ns"] - packet["written_ns"],
                pose["written_ns"] - packet["written_ns"],
                pose["received_ns"] - pose["written_ns"])):
            stage.append(ns)
    return stages


def tracking_errors_px(poses, truth):
    """How far each pose is from where the object was, and how many poses were not TRACKING."""
    errors = []
    for pose in poses:
        place = truth.get((pose["t_us"], pose["object_id"]))
        if place is not None:
            errors.append(((pose["x_px"] - place[0]) ** 2 + (pose["y_px"] - place[1]) ** 2) ** 0.5)
    return errors, sum(pose["state"] != TRACKING for pose in poses)
