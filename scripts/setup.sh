#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Installs what is missing (arguments: further packages), builds the plugin and installs it where plain `yade` finds it.
# Idempotent, quick when done. No package is ever removed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
logs=$(mktemp -d) # for this user alone
trap 'rm -rf "$logs"' EXIT

release=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
case $release in
    bookworm | trixie) ;; # the names of all packages are the same in both
    *) echo "This is no release that the plugin is known to work on (Debian 12 bookworm, Debian 13 trixie) but '$release':" \
            "packages may have other names, and its YADE may be refused." >&2 ;;
esac
packages=(yade cmake g++ make libboost-python-dev libboost-serialization-dev libeigen3-dev libcgal-dev libvtk9-dev
          coinor-libclp1 libxml2-dev libgl-dev python3-dev python3-matplotlib python3-numpy python3-vtk9 python3-scipy python3-meshio
          python3-openturns python3-pytest python3-hypothesis doctest-dev git "$@")
missing=()
for package in "${packages[@]}"; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
if ((${#missing[@]})); then
    if ((EUID != 0)); then
        echo "Please install these Debian packages first, as root:" >&2
        echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
        exit 1
    fi
    export DEBIAN_FRONTEND=noninteractive
    install=(apt-get install --no-install-recommends)
    apt-get update >"$logs/install" 2>&1 && LC_ALL=C "${install[@]}" --simulate "${missing[@]}" >"$logs/plan" 2>>"$logs/install" ||
        { tail -n 20 "$logs/install" >&2; exit 1; }
    removed=$(awk '$1 == "Remv" { print $2 }' "$logs/plan" | xargs)
    if [[ -n "$removed" ]]; then
        echo "To install ${missing[*]}, apt-get would remove ${removed}. Nothing was changed; remove these yourself if you" \
            "can do without them, or build in a chroot." >&2
        exit 1
    fi
    echo "installing ${missing[*]}"
    "${install[@]}" --yes --no-remove "${missing[@]}" >>"$logs/install" 2>&1 || { tail -n 20 "$logs/install" >&2; exit 1; }
fi

# Without root the package goes to the user's own folder, which plain yade searches too.
places=()
((EUID == 0)) || places=(-DMASONRY_PACKAGES="$(/usr/bin/python3 -P -m site --user-site)")
commit=$(git describe --always --dirty 2>/dev/null || echo unknown)
{ cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DMASONRY_COMMIT="$commit" "${places[@]}" &&
    cmake --build build --parallel "$(nproc)" && cmake --install build; } >"$logs/build" 2>&1 ||
    { tail -n 40 "$logs/build" >&2; exit 1; }
