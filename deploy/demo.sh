#!/usr/bin/env bash
# Watch Pursuit work: installs what is missing, builds, runs the three services on loopback, and
# writes one HTML page of what happened.
#
#   deploy/demo.sh
#       a van overtakes a car and hides it on the way; both are tracked, live
#   deploy/demo.sh RECORDING MODEL[@x,y,theta[,scale]]...
#       the same on a recording of events with shape models of your own
#
# Options before the arguments: --no-install, --output PAGE.html, --rate R (times real time)
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
page=$PWD/pursuit-demo.html
install=1 rate=1
while [[ ${1:-} == --* ]]; do
    case $1 in
        --no-install) install=0; shift ;;
        --output) page=$(realpath -m "$2"); shift 2 ;;
        --rate) rate=$2; shift 2 ;;
        --help) sed -n '2,11s/^# \{0,1\}//p' "$0"; exit 0 ;;
        *) echo "demo.sh: unknown option $1" >&2; exit 2 ;;
    esac
done
recording=${1:+$(realpath "$1")}
[[ -z $recording || $# -ge 2 ]] || { echo "demo.sh: give at least one model with the recording" >&2; exit 2; }

say() { printf '\n== %s\n' "$*"; }

say "packages and build (the first time takes some minutes)"
((install)) && "$root/deploy/install-dependencies.sh" build
(cd "$root" && cmake --preset release >/dev/null &&
    cmake --build --preset release --target pursuit-sensor pursuit-tracker pursuit-recorder pursuitctl)
bin=$root/build/release/bin

work=$(mktemp -d)
pids=()
finish() {
    local status=$?
    for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
    wait 2>/dev/null || true
    if ((status == 0)); then rm -rf "$work"; else echo "the demo failed; what it wrote is in $work" >&2; fi
}
trap finish EXIT

# A domain that nobody else of this host is likely to use.
domain=$((100 + RANDOM % 100))
service() { # NAME field=value ...
    local name=$1; shift
    local settings=(--set "dds.domain=$domain" --set dds.loopback_only=true)
    for setting in "$@"; do settings+=(--set "$setting"); done
    "$bin/pursuit-$name" "${settings[@]}" 2>"$work/$name.log" &
    pids+=($!)
}
ctl() { local command=$1; shift; "$bin/pursuitctl" "$command" "$@" --domain "$domain" --loopback; }

models=() truth=()
if [[ -z $recording ]]; then
    say "the scene: a van at 42 px/s overtakes a car at 24 px/s"
    "$bin/pursuitctl" simulate overtake --seed 4 --truth "$work/truth.csv" --models "$work/models"
    truth=(--truth "$work/truth.csv")
    while IFS=, read -r name x y theta scale mode _; do
        [[ $name == object ]] || models+=("$work/models/model_$name.csv@$x,$y,$theta,$scale")
    done <"$work/models/start.csv"
    source=(scene=overtake seed=4)
    transform=isometry
else
    shift
    models=("$@")
    source=("recording=$recording")
    transform=similarity
fi

say "three services on DDS domain $domain, loopback only"
service recorder "output=$work/demo.mcap"
recorder=$!
service tracker "store=$work/tracker.store"
tracker=$!
for model in "${models[@]}"; do ctl model register "$model" --transform "$transform"; done
service sensor "${source[@]}" "rate=$rate" wait_for_subscribers=2
sensor=$!

say "poses, live"
# Not by ctl: what runs in the background would be its shell, and the viewer outlive it.
"$bin/pursuitctl" poses --domain "$domain" --loopback &
viewer=$!
pids+=("$viewer")

# The strategy for ambiguous events is switched by request while everything runs.
sleep 2
ctl strategy set weighted
sleep 2
ctl strategy set closest

wait "$sensor" || { cat "$work/sensor.log" >&2; exit 1; }
kill "$viewer"
wait "$viewer" || true
kill "$recorder"
wait "$recorder" || { cat "$work/recorder.log" >&2; exit 1; }
ctl status
kill "$tracker"
wait "$tracker" || { cat "$work/tracker.log" >&2; exit 1; }

say "what happened"
"$bin/pursuitctl" report "$work/demo.mcap" "${truth[@]}" --output "$page" --check
echo
echo "open $page"
