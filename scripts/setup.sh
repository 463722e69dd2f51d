#!/usr/bin/env bash
# Installs what is missing (arguments: further packages), builds the plugin and installs it where plain `yade` finds it.
# Idempotent, quick when done.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(yade cmake g++ make libboost-python-dev libboost-serialization-dev libeigen3-dev libvtk9-dev libxml2-dev
          python3-dev python3-matplotlib python3-numpy python3-vtk9 python3-pytest python3-hypothesis doctest-dev git "$@")
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
    echo "installing ${missing[*]}"
    log=$(mktemp)
    export DEBIAN_FRONTEND=noninteractive
    apt-get update >"$log" 2>&1 && apt-get install -y --no-install-recommends "${missing[@]}" >>"$log" 2>&1 ||
        { tail -n 20 "$log" >&2; exit 1; }
fi

# Without root the package goes to the user's own folder, which plain yade searches too.
places=()
((EUID == 0)) || places=(-DMASONRY_PACKAGES="$(/usr/bin/python3 -m site --user-site)")
commit=$(git describe --always --dirty 2>/dev/null || echo unknown)
log=$(mktemp)
{ cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DMASONRY_COMMIT="$commit" "${places[@]}" &&
    cmake --build build --parallel "$(nproc)" && cmake --install build; } >"$log" 2>&1 ||
    { tail -n 40 "$log" >&2; exit 1; }
