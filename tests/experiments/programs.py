# SPDX-License-Identifier: Apache-2.0
"""The programs that the experiments drive, and where their files are."""

import hashlib
import os
import subprocess

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
BUILD = os.environ.get("PURSUIT_BUILD", os.path.join(SOURCE, "build/release"))
BIN = os.environ.get("PURSUIT_BIN", os.path.join(BUILD, "bin"))
CTL = os.path.join(BIN, "pursuitctl")
FRAME_BASED = os.environ.get("PURSUIT_FRAME_BASED", os.path.join(BUILD, "tests/frame_based"))
DATA = os.environ.get("PURSUIT_TEST_DATA", os.path.join(SOURCE, "../shared/data"))


class Failed(Exception):
    """A program ended with an error; the message has what it said."""


def run(arguments, timeout=1800):
    """Standard output and standard error of a program that has to succeed."""
    arguments = [str(a) for a in arguments]
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=timeout)
    if done.returncode != 0:
        raise Failed(f"{' '.join(arguments)}\nexit {done.returncode}: {done.stderr.strip()}")
    return done.stdout, done.stderr


def digest_of_files(paths):
    digest = hashlib.sha1()
    for path in paths:
        with open(path, "rb") as file:
            digest.update(file.read())
    return digest.hexdigest()[:12]


_digests = {}


def digest_of_program(path):
    """Changes with every build that is another program."""
    if path not in _digests:
        _digests[path] = digest_of_files([path])
    return _digests[path]


def digest_of_simulator():
    """Of what decides which events a scene has; without its sources, of the program."""
    if "simulator" not in _digests:
        folder = os.path.join(SOURCE, "services/sensor/scene")
        paths = [os.path.join(SOURCE, "idl/scene.proto")]
        for root, _, names in os.walk(folder):
            paths += [os.path.join(root, n) for n in names if not n.endswith(".textproto")]
        _digests["simulator"] = digest_of_files(sorted(paths))
    return _digests["simulator"]
