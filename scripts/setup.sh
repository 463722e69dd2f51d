#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Installs what is missing for runs, builds the plugin and installs it where plain `yade` finds it. Idempotent, quick when
# done. No package is ever removed. Exit status 100, as that of apt-get, says that packages cannot be had or installed.
#
#   bash scripts/setup.sh                        what a run needs, with its figures and bounds
#   bash scripts/setup.sh --tests [PACKAGE...]   also what tests and studies need, further packages, and the C++ of tests
#   bash scripts/setup.sh --with PACKAGE...      what a run needs, and further packages
#   bash scripts/setup.sh --no-build             the packages that a plugin needs which was built elsewhere; builds nothing
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
logs=$(mktemp -d) # for this user alone
trap 'rm -rf "$logs"' EXIT

release=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
case $release in
    bookworm | trixie | forky) ;; # the names of all packages are the same in them
    resolute) ;; # Ubuntu 26.04, whose packages come from Debian's; not tried
    *) echo "This is not a release that the plugin is known to work on (Debian 12 bookworm, 13 trixie, forky) but '$release':" \
            "packages may have other names, and its YADE may be refused." >&2 ;;
esac
# Python's numpy, scipy and matplotlib and the libraries of VTK come with yade, so figures and bounds need little more.
runs=(yade python3-jinja2 python3-matplotlib python3-numpy python3-scipy python3-meshio python3-svgelements python3-ezdxf
    coinor-libclp1)
builds=(cmake g++ make libboost-python-dev libboost-serialization-dev libeigen3-dev libcgal-dev libgl-dev python3-dev)
tests=OFF target=masonry_module_fit packages=("${runs[@]}" "${builds[@]}")
case "${1:-}" in
    "") ;;
    --tests)
        tests=ON target=all
        packages+=(python3-pytest python3-hypothesis python3-openturns python3-vtk9 doctest-dev git "${@:2}")
        ;;
    --with) packages+=("${@:2}") ;;
    --no-build) packages=("${runs[@]}") ;;
    *) sed -n '6,9s/^# *//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
esac

# Says what is done and how long it took where it was measured, on two cores of a server, then how far it is: on a terminal
# in place, else nothing but the end. Reads the lines of apt-get's status and of make from the standard input.
progress() {
    local what=$1 usual=$2 line part started=$SECONDS
    echo "$what (usually about $usual)"
    while IFS= read -r line; do
        part=
        [[ $line =~ ^dlstatus:[^:]*:([0-9]+) ]] && part="fetched ${BASH_REMATCH[1]} %"
        [[ $line =~ ^pmstatus:[^:]*(:[a-z0-9]+)?:([0-9]+)\. ]] && part="unpacked and set up ${BASH_REMATCH[2]} %"
        [[ $line =~ ^\[\ *([0-9]+)%\] ]] && part="compiled ${BASH_REMATCH[1]} %"
        [[ -z $part || ! -t 1 ]] || printf '\r  %-32s' "$part, $((SECONDS - started)) s"
    done
    [[ ! -t 1 ]] || printf '\r%-40s\r' ''
    echo "  ended after $((SECONDS - started)) s"
}

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
        { tail -n 20 "$logs/install" >&2; exit 100; }
    removed=$(awk '$1 == "Remv" { print $2 }' "$logs/plan" | xargs)
    if [[ -n "$removed" ]]; then
        echo "To install ${missing[*]}, apt-get would remove ${removed}. Nothing was changed; remove these yourself if you" \
            "can do without them, or build in a chroot." >&2
        exit 100
    fi
    number=$(grep -c '^Inst ' "$logs/plan" || true)
    "${install[@]}" --yes --no-remove -o APT::Status-Fd=3 "${missing[@]}" 3>&1 >>"$logs/install" 2>&1 |
        progress "installing ${missing[*]}: $number packages with what they need" "$((5 + number / 5)) s" ||
        { tail -n 20 "$logs/install" >&2; exit 100; }
fi

[[ "${1:-}" != --no-build ]] || exit 0

# Unpacks a package into a folder, without installing it or what it would bring or remove.
unpack() {
    (cd "$logs" && apt-get download "$1" && dpkg -x "$1"_*.deb unpacked) >"$logs/unpack.log" 2>&1 || {
        tail -n 20 "$logs/unpack.log" >&2
        echo "$3" >&2
        exit 100
    }
    mkdir -p "$(dirname "$2")" && rm -rf "$2" && mv "$logs/unpacked" "$2"
}

# Of libvtk9-dev only the headers are needed. They are unpacked, for installed it would bring 250 packages with it.
if ! compgen -G '/usr/include/vtk-9.*/vtkXMLUnstructuredGridWriter.h' >/dev/null &&
    ! compgen -G 'build/vtk/usr/include/vtk-9.*/vtkXMLUnstructuredGridWriter.h' >/dev/null; then
    unpack libvtk9-dev build/vtk \
        "The headers of VTK could not be fetched. As root: apt-get install --no-install-recommends libvtk9-dev"
fi
# Installed, ParaView's Python would remove python3-vtk9.
paraview=~/.local/share/masonry/paraview # where view.py looks for it
if [[ " ${packages[*]} " == *" paraview "* && ! -d $paraview && ! -d /usr/lib/python3/dist-packages/paraview ]]; then
    unpack python3-paraview "$paraview" "ParaView's Python could not be fetched."
fi

# Without root the package goes to the user's own folder, which plain yade searches too.
places=()
((EUID == 0)) || places=(-DMASONRY_PACKAGES="$(/usr/bin/python3 -P -m site --user-site)")
failed() { tail -n 40 "$logs/build" >&2; exit 1; }
cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DMASONRY_TESTS=$tests -UMASONRY_COMMIT "${places[@]}" >"$logs/build" 2>&1 || failed
build=(cmake --build build --parallel "$(nproc)" --target "$target")
# `make -n` names every compilation that is to come; without any there is nothing to wait for.
count=$(make -C build -n "$target" 2>/dev/null | grep -c 'Building C' || true)
if ((count > 2)); then
    seconds=90
    [[ $tests == OFF ]] || seconds=150
    "${build[@]}" 2>&1 | tee -a "$logs/build" | progress "compiling the plugin on $(nproc) cores" "$seconds s on two cores" || failed
else
    "${build[@]}" >>"$logs/build" 2>&1 || failed
fi
cmake --install build >>"$logs/build" 2>&1 || failed
