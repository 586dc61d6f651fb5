#!/usr/bin/env bash
# The paper's experiments, again, with this tracker: tables, curves and pages.
#
#   tests/experiments/run.sh [GROUP]... [--quick] [--seeds N] [--jobs N] [--out FOLDER] [--readme]
#
# Without a group all of them run; `--list` names them. Interrupted, it goes on where it was. Needs
# a release build (build/release/bin, or PURSUIT_BIN) and, for recorded streams, PURSUIT_TEST_DATA.
set -euo pipefail
exec /usr/bin/python3 "$(dirname "$0")/run.py" "$@"
