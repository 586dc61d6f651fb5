# SPDX-License-Identifier: Apache-2.0
"""Runs trackers over streams, keeps what came of it, and sums it up.

Every score is kept in scores.jsonl under what it depends on, so that an interrupted run goes on
where it was and a changed program is run anew.
"""

import hashlib
import json
import math
import os
import statistics
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor

from programs import CTL, Failed, run
from streams import SYMMETRY


class Scores:
    def __init__(self, folder, jobs):
        self.folder = folder
        self.jobs = jobs
        self.streams = os.path.join(folder, "streams")
        os.makedirs(self.streams, exist_ok=True)
        self.path = os.path.join(folder, "scores.jsonl")
        self.known = {}
        self.lock = threading.Lock()
        if os.path.exists(self.path):
            with open(self.path) as file:
                for line in file:
                    try:
                        entry = json.loads(line)
                    except json.JSONDecodeError:
                        continue  # the last line of a run that was interrupted
                    self.known[entry["key"]] = entry["result"]

    def of(self, cases, d1=False):
        """{case: result} of (stream, tracker) pairs, in their order; shows progress."""
        cases = list(dict.fromkeys(cases))
        missing = [c for c in cases if self._key(c, d1) not in self.known]
        # One stream's trackers follow each other: its files are still in memory.
        begin = time.monotonic()
        done = 0

        def score(case):
            nonlocal done
            result = self._score(case, d1)
            with self.lock:
                done += 1
                self._keep(self._key(case, d1), result)
                spent = time.monotonic() - begin
                left = spent / done * (len(missing) - done)
                sys.stderr.write(f"\r  {done}/{len(missing)} {case[0].name} {case[1].label}: "
                                 f"{spent:.0f} s, {left:.0f} s left \033[K")
                sys.stderr.flush()

        with ThreadPoolExecutor(self.jobs) as pool:
            for _ in pool.map(score, missing):
                pass
        if missing:
            sys.stderr.write("\n")
        return {c: self.known[self._key(c, d1)] for c in cases}

    def curves(self, case, compute, name):
        """compute(files, poses_path) of one case, kept as well."""
        key = f"curves {name} {self._key(case, False)}"
        if key not in self.known:
            stream, tracker = case
            with tempfile.TemporaryDirectory() as folder:
                files = stream.files(self.streams)
                poses, _ = tracker.track(files, folder)
                self._keep(key, compute(files, poses))
        return self.known[key]

    def _key(self, case, d1):
        stream, tracker = case
        text = f"{stream.key()} | {tracker.key()}{' | D1' if d1 else ''}"
        return hashlib.sha1(text.encode()).hexdigest()[:20]

    def _keep(self, key, result):
        self.known[key] = result
        with open(self.path, "a") as file:
            file.write(json.dumps({"key": key, "result": result}) + "\n")

    def _score(self, case, d1):
        stream, tracker = case
        files = stream.files(self.streams)
        with tempfile.TemporaryDirectory() as folder:
            try:
                poses, wall_s = tracker.track(files, folder)
            except Failed as failure:
                return {"failed": str(failure)[-400:], "objects": {}}
            arguments = [CTL, "evaluate", "--json", "--poses", poses, "--truth", files.truth,
                         "--from", files.scored_from_s, "--speed-window", files.speed_window_s]
            for name, path in files.true_models.items():
                arguments += ["--model", f"{name}={path}"]
                if name in SYMMETRY:
                    arguments += ["--symmetry", f"{name}={SYMMETRY[name]}"]
            if d1:
                arguments += ["--events", files.events]
            text, _ = run(arguments)
            result = {"wall_s": wall_s, "events": os.path.getsize(files.events) // 8}
            status = os.path.join(folder, "status.json")
            if os.path.exists(status):
                with open(status) as file:
                    result["status"] = json.load(file)
        objects = json.loads(text)
        for row in files.objects:
            # A shape that was searched for may be found turned by one of its own turns.
            score = objects.get(row["object"])
            is_searched = row["mode"] == "search" or getattr(tracker, "searches", False)
            if is_searched and score and "lost_symmetric" in score:
                score.update(lost=score["lost_symmetric"], E=score["E_symmetric"],
                             lies=score["lies_symmetric"])
        return {"objects": objects, **result}


def objects_of(results, cases, name=None):
    """The scores of every object of the cases, or of those of one name."""
    found = []
    for case in cases:
        for object_name, score in results[case]["objects"].items():
            if name is None or object_name.split("#")[0] == name:
                found.append(score)
    return found


def failures_of(results, cases):
    return [results[c]["failed"] for c in cases if "failed" in results[c]]


def mean(scores, field):
    """Over those that were not lost; nothing where none is left."""
    values = [s[field] for s in scores if not s["lost"] and s.get(field) is not None]
    return statistics.fmean(values) if values else math.nan


def worst(scores, field):
    values = [s[field] for s in scores if not s["lost"] and s.get(field) is not None]
    return max(values) if values else math.nan


def median(scores, field):
    values = [s[field] for s in scores if not s["lost"] and s.get(field) is not None]
    return statistics.median(values) if values else math.nan


def lost(scores):
    return sum(bool(s["lost"]) for s in scores)


def lies(scores):
    """How many objects were ever said confidently to be where they were not."""
    return sum(bool((s.get("lies") or 0) > 0) for s in scores)


def number(value, digits=2):
    return "–" if value is None or not math.isfinite(value) else f"{value:.{digits}f}"


def lost_and_error(scores, field="E", digits=2):
    """"lost of all / mean of those kept", as "0 of 8 / 0.15"."""
    if not scores:
        return "–"
    return f"{lost(scores)} of {len(scores)} / {number(mean(scores, field), digits)}"
