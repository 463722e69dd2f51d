#!/usr/bin/env bash
# Sets up what is missing and runs tests, fastest ring first.
#
#   bash scripts/test.sh                   all tests but those with sanitizers, on all cores side by side
#   bash scripts/test.sh quick             law, blocks, files and the fast part of the host: under a minute
#   bash scripts/test.sh tests/law ...     these tests alone, one after the other; all arguments go to pytest
#   bash scripts/test.sh tests/sanitizers  memory, arithmetic, and races between threads, for which the plugin is built twice
#                                          more: some ten minutes
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [[ "${1:-}" == quick ]]; then
    shift
    bash scripts/setup.sh python3-pytest-xdist
    tests=(tests/law tests/blocks tests/files tests/host -m "not slow" "$@")
    workers=$(nproc)
else
    # for fuzz and sanitizers, and for studies
    bash scripts/setup.sh python3-pytest-xdist clang libclang-rt-dev libomp-dev slurm-wlm munge
    (($#)) && tests=("$@") || tests=(tests --ignore tests/sanitizers)
    workers=$(($# ? 0 : $(nproc)))
fi
export OMP_NUM_THREADS=1 # so that workers do not take each other's cores; a test that needs threads asks for them
exec /usr/bin/python3 -m pytest -q -p no:cacheprovider -W ignore::DeprecationWarning \
    --numprocesses "$workers" --dist loadgroup "${tests[@]}"
