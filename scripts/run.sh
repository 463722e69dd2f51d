#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Sets up what is missing and runs a scene:  bash scripts/run.sh wall_comp4 [options of the scene]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scene=${1:-wall_comp4}
path=$here/$scene.py
[[ -f $path ]] || path=$here/gallery/$scene.py
[[ -f $path ]] || { echo "no scene '$scene'; there are: $(cd "$here" && basename -s .py -- *.py gallery/*.py | xargs)" >&2; exit 2; }
bash "$here/setup.sh"
export HOME=${HOME:-$(echo ~)}  # YADE ends without it
exec yade -n -x "$path" "${@:2}"
