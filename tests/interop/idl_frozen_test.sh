#!/usr/bin/env bash
# No published type has changed: the IDL files are those of the frozen digests.
#
#   idl_frozen_test.sh IDL_FOLDER DIGESTS
set -euo pipefail
cd "$1"
if ! sha256sum --check --quiet "$2"; then
    echo "A published type may not change: add a new version module, then freeze it with"
    echo "  (cd idl && sha256sum *.idl) > tests/interop/idl.sha256"
    exit 1
fi
listed=$(wc -l <"$2") present=$(ls ./*.idl | wc -l)
((listed == present)) || { echo "$present IDL files, $listed frozen"; exit 1; }
echo "$present IDL files are as frozen"
