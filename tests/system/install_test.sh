#!/usr/bin/env bash
# What the installed units name is where `cmake --install` puts it, and a configuration that is
# there already is left as it is.
#
#   install_test.sh BUILD_FOLDER
set -euo pipefail
build=$1
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
DESTDIR=$root cmake --install "$build" --prefix /usr >"$root/log" || { cat "$root/log"; exit 1; }

fail() { echo "$*" >&2; exit 1; }
count=0
for unit in "$root"/usr/lib/systemd/system/pursuit-*.service; do
    name=$(basename "$unit")
    read -r program option configuration <<<"$(sed -n 's/^ExecStart=//p' "$unit")"
    documentation=$(sed -n 's|^Documentation=file://||p' "$unit")
    user=$(sed -n 's/^User=//p' "$unit")
    [[ -x $root$program ]] || fail "$name: $program is not installed"
    [[ -f $root$documentation ]] || fail "$name: $documentation is not installed"
    grep -q "^u $user " "$root/usr/lib/sysusers.d/pursuit.conf" || fail "$name: nobody makes $user"
    # The sample names nothing that a new host has not.
    "$root$program" "$option" "$root$configuration" --check
    echo "$name finds what it names"
    count=$((count + 1))
done
((count == 3)) || fail "expected 3 units, found $count"
"$root/usr/bin/pursuitctl" --version
for link in $(grep -o '`docs/[a-z-]*\.md`\|`idl/README.md`' "$root/usr/share/doc/pursuit/README.md" | tr -d '`'); do
    [[ -f $root/usr/share/doc/pursuit/$link ]] || fail "README.md names $link, which is not installed"
done

echo 'sensor_id: 7' >"$root/etc/pursuit/tracker.textproto"
DESTDIR=$root cmake --install "$build" --prefix /usr >"$root/log"
[[ $(<"$root/etc/pursuit/tracker.textproto") == 'sensor_id: 7' ]] || fail "a configuration was written over"
