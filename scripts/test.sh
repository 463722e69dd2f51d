#!/usr/bin/env bash
# Sets up what is missing and runs all tests, fastest ring first. Arguments go to pytest.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/setup.sh clang-14 libclang-rt-14-dev libomp-14-dev # for tests/fuzz and tests/sanitizers
exec /usr/bin/python3 -m pytest -q -p no:cacheprovider -W ignore::DeprecationWarning "${@:-tests}"
