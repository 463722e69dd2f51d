#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Sets up what is missing and runs tests, fastest ring first.
#
#   bash scripts/test.sh                   the tests but those with sanitizers and the longest, on all cores side by side
#   bash scripts/test.sh all               the longest, too, among them the site of the documentation and fuzz
#   bash scripts/test.sh quick             C++ of each layer, the gates, and the fast part of the host: under a minute
#   bash scripts/test.sh tests/law ...     these tests alone, one after the other; all arguments go to pytest
#   bash scripts/test.sh tests/sanitizers  memory, arithmetic, and races between threads, for which the plugin is built twice
#                                          more: some ten minutes
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [[ "${1:-}" == quick ]]; then
    shift
    # for the gates: formats of C++ and Python, unused imports
    bash scripts/setup.sh --tests python3-pytest-xdist clang-format black python3-pyflakes
    tests=(tests/common tests/law tests/motion tests/blocks tests/contact tests/files tests/gates tests/host -m "not slow" "$@")
    workers=$(nproc)
else
    # For gates, sanitizers, studies, YADE's 3-D view, the page in 3-D, and notebooks; for all tests also the site of the documentation
    # and fuzz. ParaView is not among them: it is 77 MB, and its thirteen tests take two minutes; where it is installed as
    # scripts/README.md says under "Pictures", they run. Nor is Chromium, which is larger: apt-get install
    # --no-install-recommends chromium lets the page's tests in it run.
    longest=()
    [[ "${1:-}" == "" ]] || longest=(clang libclang-rt-dev python3-sphinx python3-myst-parser furo libjs-mathjax)
    bash scripts/setup.sh --tests python3-pytest-xdist clang-format black python3-pyflakes mypy python3-yaml slurm-wlm munge \
        xvfb xauth libjs-three jupyter-nbconvert python3-ipykernel python3-pandas "${longest[@]}"
    workers=$(nproc)
    case "${1:-}" in
        "") tests=(tests --ignore tests/sanitizers -m "not long") ;;
        all) tests=(tests --ignore tests/sanitizers) ;;
        *) tests=("$@") workers=0 ;;
    esac
fi
export OMP_NUM_THREADS=1 # so that workers do not take each other's cores; a test that needs threads asks for them
exec /usr/bin/python3 -m pytest -q -p no:cacheprovider -W ignore::DeprecationWarning \
    --numprocesses "$workers" --dist loadgroup "${tests[@]}"
