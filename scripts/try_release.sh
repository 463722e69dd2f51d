#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Tries in a fresh Debian both commands of README.md, tests of what uses libraries, then the Debian package of the last
# commit: built of what it says that it needs, installed, tested by autopkgtest. Prints outcome, time and peak in a line
# for each. Fails if one of them does. A release whose own packages cannot be had or installed today is a note: forky moves.
#
#   bash scripts/try_release.sh bookworm|trixie|forky...      in a temporary folder, which is removed at the end
#   FOLDER=/some/new/folder bash scripts/try_release.sh trixie
#   KEEP=1 FOLDER=/some/new/folder bash scripts/try_release.sh trixie     leaves the release there, for more trials
#   MIRROR=http://... bash scripts/try_release.sh trixie      another package mirror than that of this machine
#
# Needs root, debootstrap, dpkg-dev, 8 GB in FOLDER and a quarter of an hour for a release. What is tried is this working
# tree.
set -euo pipefail
NO_PACKAGES=100 # exit status of scripts/setup.sh if apt-get fails
# Tests of what uses libraries that differ between releases: OpenTURNS, ezdxf, matplotlib, notebooks, NumPy's type hints.
LIBRARIES="tests/study tests/package tests/view tests/gates/test_hints.py -m 'not long' --numprocesses $(nproc)"
cd "$(dirname "${BASH_SOURCE[0]}")/.."

(($#)) || { sed -n '3,11s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2; }
for release in "$@"; do
    [[ $release =~ ^(bookworm|trixie|forky)$ ]] || { echo "release '$release' must be bookworm, trixie or forky" >&2; exit 2; }
done
((EUID == 0)) || { echo "needs root, for chroot" >&2; exit 1; }
command -v debootstrap >/dev/null || { echo "needs debootstrap: apt-get install debootstrap" >&2; exit 1; }
# the mirror from which this machine has its own packages; if it is no Debian, that of debootstrap
mirror=${MIRROR:-$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' 2>/dev/null | sed -n 1p || true)}
folder=${FOLDER:-$(mktemp -d)}
mkdir -p "$folder"
[[ -z $(ls -A "$folder") ]] || { echo "FOLDER $folder must be empty" >&2; exit 1; }
chmod 755 "$folder"

clean() {
    for root in "$folder"/*/; do
        umount "$root/proc" "$root/sys" 2>/dev/null || true
        [[ -z ${KEEP:-} ]] || continue
        grep -qs " ${root%/}/" /proc/mounts || rm -rf --one-file-system "$root"
    done
    [[ -n ${KEEP:-} ]] || rm -f "$folder"/*.log
    rmdir "$folder" 2>/dev/null || true
}
trap clean EXIT

# In the release: a command from the working tree there. Its output goes to a log, whose end is shown if it fails.
inside() {
    local started=$SECONDS
    chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
        bash -c "cd /root/masonry && $*" >"$folder/$release.log" 2>&1 && outcome=ok || outcome="exit $?"
    seconds=$((SECONDS - started))
    [[ $outcome == ok ]] || tail -n 40 "$folder/$release.log" >&2
}

# Leaves a release out, with a note and the end of its log.
skip() {
    tail -n 20 "$folder/$release.log" >&2
    echo "note: release $release was not tried: $1" >&2
    clean
    mkdir -p "$folder"
}

bash scripts/package.sh --source
lines=("release|yade|command|outcome|time [s]|peak [kN]")
for release in "$@"; do
    root=$folder/$release
    started=$SECONDS
    script= # a debootstrap that is older than the release makes it as sid
    [[ -e /usr/share/debootstrap/scripts/$release ]] || script=/usr/share/debootstrap/scripts/sid
    debootstrap --variant=minbase "$release" "$root" "$mirror" ${script:+"$script"} >"$folder/$release.log" 2>&1 ||
        { skip "debootstrap failed"; continue; }
    lines+=("$release|-|debootstrap|ok|$((SECONDS - started))|-")
    printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d" # no package starts a service
    chmod +x "$root/usr/sbin/policy-rc.d"
    # a mirror that is kept as it was one day offers lists whose date is over
    echo 'Acquire::Check-Valid-Until "false";' >"$root/etc/apt/apt.conf.d/99-old-mirror"
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io" # nobody keeps this system
    mount -t proc proc "$root/proc"
    mount -t sysfs -o ro sysfs "$root/sys" # where OpenTURNS looks for cores
    mkdir "$root/root/masonry"
    git ls-files -z --cached --others --exclude-standard | tar -c --null --files-from=- | tar -x -C "$root/root/masonry"
    inside bash scripts/run.sh wall_comp4
    [[ $outcome != "exit $NO_PACKAGES" ]] || { skip "its packages cannot be had or installed"; continue; }
    yade=$(chroot "$root" dpkg-query -W -f '${Version}' yade 2>/dev/null || echo none)
    json=$root/root/masonry/results/wall_comp4/run.json
    peak=none
    [[ -f $json ]] && peak=$(chroot "$root" /usr/bin/python3 -c \
        'import json, sys; print(json.load(sys.stdin)["peak_base_shear_kN"])' <"$json")
    lines+=("$release|$yade|bash scripts/run.sh wall_comp4|$outcome|$seconds|$peak")
    for tests in quick "$LIBRARIES"; do
        inside "bash scripts/test.sh $tests"
        [[ $outcome != "exit $NO_PACKAGES" ]] || { skip "packages for tests cannot be had or installed"; continue 2; }
        passed=$(tail -n 1 "$folder/$release.log")
        lines+=("$release|$yade|bash scripts/test.sh $tests|$outcome: $passed|$seconds|-")
    done
    # the package is tried alone, without what setup.sh has installed
    mkdir "$root/root/package"
    find build/package -name 'yade-masonry_*' -exec cp -t "$root/root/package" {} +
    inside 'apt-get build-dep --yes --no-install-recommends /root/package/*.dsc &&
        apt-get install --yes --no-install-recommends autopkgtest && rm -r /usr/local/lib/python3*/dist-packages/masonry*'
    [[ $outcome != "exit $NO_PACKAGES" ]] || { skip "packages for the Debian package cannot be had or installed"; continue; }
    lines+=("$release|$yade|apt-get build-dep|$outcome|$seconds|-")
    inside 'DEB_BUILD_OPTIONS=nocheck bash scripts/package.sh /root/package/*.dsc'
    lines+=("$release|$yade|bash scripts/package.sh|$outcome|$seconds|-")
    if [[ $outcome == ok ]]; then
        inside 'autopkgtest --no-built-binaries build/package/*.deb /root/package/*.dsc -- null'
        lines+=("$release|$yade|autopkgtest|$outcome|$seconds|-")
    fi
    mv "$folder/$release.log" "${TMPDIR:-/tmp}/try_release_$release.log"
    clean
    mkdir -p "$folder"
done
printf '%s\n' "${lines[@]}" | column -t -s '|'
[[ "${lines[*]}" != *"|exit "* ]]
