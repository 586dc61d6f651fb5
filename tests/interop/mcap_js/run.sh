#!/usr/bin/env bash
# run.sh BUILD_FOLDER WRITE_SAMPLE READ_FOREIGN: lets the JavaScript library of the MCAP project read
# what we write, and us what it writes. Its packages are installed into the build folder, once for each package.json.
set -euo pipefail
source=$(cd "$(dirname "$0")" && pwd)
build=$1
write_sample=$2
read_foreign=$3

skip() {
    echo "skipped: $*"
    exit 77
}
command -v node >/dev/null || skip "node is not installed"
command -v npm >/dev/null || skip "npm is not installed"
# The reader's packages need the regular expressions and modules of node 18.
(($(node -p 'process.versions.node.split(".")[0]') >= 18)) || skip "node is older than 18"

mkdir -p "$build"
cp "$source"/*.mjs "$build"
if ! cmp -s "$source/package.json" "$build/installed.json"; then
    cp "$source/package.json" "$build"
    # Where the registry is out of reach, npm itself takes two minutes to say so.
    answer=$(cd "$build" && timeout 20 npm view @mcap/core name --fetch-retries=1 \
        --fetch-retry-mintimeout=1000 --fetch-timeout=10000 2>&1) || {
        reason=$(grep -E '^npm (error|ERR!) (code|[a-z]+ request)' <<<"$answer" | tr '\n' ' ' || true)
        skip "the registry of npm does not answer: ${reason:-nothing within 20 s}"
    }
    log=$(cd "$build" && timeout 120 npm install --no-package-lock --no-audit --no-fund 2>&1) ||
        skip "npm could not install the reader: $(tail -n 3 <<<"$log" | tr '\n' ' ')"
    cp "$source/package.json" "$build/installed.json"
fi
"$write_sample" "$build"
node "$build/read_sample.mjs" "$build"
node "$build/write_foreign.mjs" "$build"
for file in chunked plain; do "$read_foreign" "$build/foreign_$file.mcap" 500; done
