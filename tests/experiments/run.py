#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""One command for all experiments; see run.sh."""

import argparse
import importlib
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import programs  # noqa: E402
from scores import Scores  # noqa: E402

# In the order of the paper; each a module of figures/ with run(settings) -> Page.
GROUPS = ("rotating_star", "live", "points_and_rate", "affine", "road", "strategies", "moving_camera",
          "every_scene", "parts", "disc_sensors", "starts_and_gaps", "recorded")

README = os.path.join(programs.HERE, "README.md")


class Settings:
    """What a group is run with."""

    def __init__(self, options):
        self.quick = options.quick
        self.scores = Scores(options.out, options.jobs)
        self.seed_count = options.seeds or (2 if options.quick else 8)

    def seeds(self, count=None):
        """Seeds that nothing was tuned on. (101 to 108 were these until they were looked into.)"""
        return range(1001, 1001 + (count or self.seed_count))

    def tuning_seeds(self):
        """For constants that are chosen by trying them."""
        return range(1, 3 if self.quick else 4)


def update_readme(name, markdown, command):
    """Puts a group's tables between its marks."""
    begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->\n"
    with open(README) as file:
        text = file.read()
    part = f"{begin}{markdown}\nMade by `{command}`.\n\n{end}"
    if begin in text:
        head, rest = text.split(begin, 1)
        text = head + part + rest.split(end, 1)[1]
    else:
        text += "\n" + part
    with open(README, "w") as file:
        file.write(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("group", nargs="*", help=f"of {', '.join(GROUPS)}; none: all")
    parser.add_argument("--list", action="store_true", help="name the groups")
    parser.add_argument("--quick", action="store_true", help="a short subset: few seeds and scenes")
    parser.add_argument("--seeds", type=int, default=0, help="how many; 0: 8, or 2 when quick")
    parser.add_argument("--jobs", type=int, default=2, help="processes at a time")
    parser.add_argument("--out", default=os.path.join(programs.BUILD, "experiments"))
    parser.add_argument("--readme", action="store_true", help="put the tables into README.md")
    options = parser.parse_args()
    if options.list:
        print("\n".join(GROUPS))
        return
    for group in options.group:
        if group not in GROUPS:
            parser.error(f"no group {group}; there are {', '.join(GROUPS)}")
    settings = Settings(options)
    for group in options.group or GROUPS:
        begin = time.monotonic()
        print(f"{group} …", file=sys.stderr, flush=True)
        page = importlib.import_module("figures." + group).run(settings)
        page.write(options.out)
        if options.readme:
            with open(os.path.join(options.out, page.name + ".md")) as file:
                update_readme(group, file.read(), f"tests/experiments/run.sh {group}"
                              f"{' --quick' if options.quick else ''}"
                              f"{f' --seeds {options.seeds}' if options.seeds else ''}")
        print(f"{os.path.join(options.out, page.name)}.html ({time.monotonic() - begin:.0f} s)",
              flush=True)


if __name__ == "__main__":
    main()
