#!/usr/bin/env bash
# Every unit is accepted by systemd-analyze verify without a word, against the built programs, and
# asks for protection.
#
#   systemd_units_test.sh UNIT_FOLDER PROGRAM_FOLDER
set -euo pipefail
units=$1 programs=$2
command -v systemd-analyze >/dev/null || { echo "skipped: systemd-analyze is not installed"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
count=0
for unit in "$units"/*.service; do
    name=$(basename "$unit")
    # The programs are looked for where they will be installed; point the copy at the built ones.
    sed "s|/usr/bin/pursuit-|$programs/pursuit-|" "$unit" >"$work/$name"
    said=$(systemd-analyze verify --man=no "$work/$name" 2>&1) || { echo "$name: $said"; exit 1; }
    # The user is made at installation, not by the build.
    said=$(grep -v 'user .*pursuit' <<<"$said" || true)
    if [[ -n $said ]]; then echo "$name: $said"; exit 1; fi
    for key in Type=notify Restart=on-failure User=pursuit StateDirectory= RestartPreventExitStatus=78; do
        grep -q "^$key" "$unit" || { echo "$name: $key is missing"; exit 1; }
    done
    # 2.8 of 10 at most; about 9 where a unit asks for no protection.
    said=$(systemd-analyze security --offline=true --threshold=28 "$work/$name" 2>&1) || {
        echo "$name is exposed: $(tail -n 1 <<<"$said")"; exit 1; }
    echo "$name is accepted"
    count=$((count + 1))
done
((count == 3)) || { echo "expected 3 units, found $count"; exit 1; }
