#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Sets up what is missing and runs tests, fastest ring first, on all cores side by side.
#
#   bash scripts/test.sh                   all tests but the long ones
#   bash scripts/test.sh long              the long ones: the longest of each ring, the site of the documentation, the pages in a
#                                          browser, runs in ParaView, fuzz, and sanitizers, for which the plugin is built twice more
#   bash scripts/test.sh all               both
#   bash scripts/test.sh quick             C++ of each layer, the gates, and the fast part of the host: under a minute
#   bash scripts/test.sh tests/law ...     these tests alone, one after the other; all arguments go to pytest
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

workers=$(nproc)
packages=(python3-pytest-xdist clang-format black python3-pyflakes) # for the gates: formats of C++ and Python, unused imports
# For gates, studies, YADE's 3-D view, pages in 3-D and notebooks.
whole=(mypy python3-yaml slurm-wlm munge xvfb xauth libjs-three jupyter-nbconvert python3-ipykernel python3-pandas)
long=(clang libclang-rt-dev python3-sphinx python3-myst-parser furo libjs-mathjax)
long+=(debhelper dh-python libvtk9-dev libgmp-dev libmpfr-dev lintian) # for the Debian package
case "${1:-}" in
    quick) tests=(tests/common tests/law tests/motion tests/blocks tests/contact tests/files tests/gates tests/host tests/limit tests/capacity -m "not slow" "${@:2}") ;;
    "") tests=(tests -m "not long") packages+=("${whole[@]}") ;;
    long) tests=(tests -m long) packages+=("${whole[@]}" "${long[@]}" chromium paraview) ;;
    all) tests=(tests) packages+=("${whole[@]}" "${long[@]}" chromium paraview) ;;
    *) tests=("$@") workers=0 packages+=("${whole[@]}" "${long[@]}") ;;
esac
bash scripts/setup.sh --tests "${packages[@]}"
export OMP_NUM_THREADS=1 # so that workers do not take each other's cores; a test that needs threads asks for them
# NumPy 2 multiplies no list or text by its bool; NumPy 1 warns, which is an error here and in programs that tests start
export PYTHONWARNINGS="error:In future" # 'np.bool_' scalars will be no index
exec /usr/bin/python3 -m pytest -q -p no:cacheprovider -W ignore::DeprecationWarning -W "$PYTHONWARNINGS" \
    --numprocesses "$workers" --dist loadgroup "${tests[@]}"
