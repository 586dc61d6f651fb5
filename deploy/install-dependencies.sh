#!/usr/bin/env bash
# Installs what is missing of what Pursuit needs, from Debian 12 alone; by sudo where not root.
#
#   deploy/install-dependencies.sh [run|build|test]...     (default: build)
#
# run    what the installed services need at run time is pulled in by the libraries of build
# build  compilers, libraries and generators
# test   what tests/run.sh needs besides: clang, Cyclone DDS, sanitizers, systemd-analyze
set -euo pipefail

build=(git ca-certificates g++ cmake ninja-build ccache mold pkg-config
       libfastrtps-dev libfastcdr-dev fastddsgen libssl-dev libasio-dev libtinyxml2-dev
       libeigen3-dev libnanoflann-dev libprotobuf-dev protobuf-compiler
       libcli11-dev libspdlog-dev libexpected-dev libzstd-dev liblz4-dev zlib1g-dev
       libflatbuffers-dev flatbuffers-compiler libpng-dev libsystemd-dev)
test=(clang-14 clang-format-14 libclang-rt-14-dev libgtest-dev libgmock-dev libbenchmark-dev
      cyclonedds-dev cyclonedds-tools python3 python3-numpy systemd npm)

wanted=()
for group in "${@:-build}"; do
    case "$group" in
        run) ;;
        build) wanted+=("${build[@]}") ;;
        test) wanted+=("${test[@]}") ;;
        *) echo "install-dependencies.sh: unknown group \"$group\" (run, build or test)" >&2; exit 2 ;;
    esac
done

# npm of another origin than Debian's serves as well, and cannot stand beside it.
missing=()
for package in "${wanted[@]}"; do
    if [[ $package == npm ]] && command -v npm >/dev/null; then continue; fi
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $status == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
    echo "every package is there"
    exit 0
fi

as_root=()
if ((EUID != 0)); then
    command -v sudo >/dev/null || { echo "not root, and there is no sudo; install: ${missing[*]}" >&2; exit 1; }
    as_root=(sudo)
fi
echo "installing: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt_get() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y \
        -o Acquire::Retries=3 -o DPkg::Lock::Timeout=120 "$@" >"$log" 2>&1 || {
        tail -n 30 "$log" >&2
        echo "apt-get $1 failed" >&2
        exit 1
    }
}
apt_get update
apt_get install --no-install-recommends "${missing[@]}"
echo "installed ${#missing[@]} packages"
