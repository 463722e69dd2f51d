#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Sets up what is missing and runs tests, fastest ring first.
#
#   bash scripts/test.sh                   all tests but those with sanitizers, on all cores side by side
#   bash scripts/test.sh quick             C++ of each layer, the gates, and the fast part of the host: under a minute
#   bash scripts/test.sh tests/law ...     these tests alone, one after the other; all arguments go to pytest
#   bash scripts/test.sh tests/sanitizers  memory, arithmetic, and races between threads, for which the plugin is built twice
#                                          more: some ten minutes
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [[ "${1:-}" == quick ]]; then
    shift
    # for the gates: formats of C++ and Python, unused imports
    bash scripts/setup.sh python3-pytest-xdist clang-format black python3-pyflakes
    tests=(tests/common tests/law tests/motion tests/blocks tests/files tests/gates tests/host -m "not slow" "$@")
    workers=$(nproc)
else
    # for gates, fuzz and sanitizers, studies; if all tests are run, for YADE's 3-D view and ParaView, too: some 70 MB
    packages=(python3-pytest-xdist clang-format black python3-pyflakes clang libclang-rt-dev libomp-dev slurm-wlm munge)
    (($#)) || packages+=(xvfb xauth paraview)
    bash scripts/setup.sh "${packages[@]}"
    # The package python3-paraview would remove python3-vtk9: it is unpacked for this user, as scripts/README.md says.
    paraview=$HOME/.local/share/masonry/paraview
    if ! (($#)) && [[ ! -d $paraview ]]; then
        folder=$(mktemp -d)
        (cd "$folder" && apt-get download python3-paraview >/dev/null 2>&1 && dpkg -x python3-paraview_*.deb "$paraview") ||
            echo "ParaView's Python could not be fetched: the tests that need it are left out" >&2
        rm -rf "$folder"
    fi
    (($#)) && tests=("$@") || tests=(tests --ignore tests/sanitizers)
    workers=$(($# ? 0 : $(nproc)))
fi
export OMP_NUM_THREADS=1 # so that workers do not take each other's cores; a test that needs threads asks for them
exec /usr/bin/python3 -m pytest -q -p no:cacheprovider -W ignore::DeprecationWarning \
    --numprocesses "$workers" --dist loadgroup "${tests[@]}"
