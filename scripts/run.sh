#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Sets up what is missing and runs a scene:  bash scripts/run.sh wall_comp4 [options of the scene]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scene=${1:-wall_comp4}
[[ -f "$here/$scene.py" ]] || { echo "no scene '$scene'; there are: $(cd "$here" && echo *.py | sed 's/\.py//g')" >&2; exit 2; }
bash "$here/setup.sh"
export HOME=${HOME:-$(echo ~)}  # YADE ends without it
exec yade -n -x "$here/$scene.py" "${@:2}"
