#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# In the container: runs a scene of the mounted folder, or one of those that the project brings.
set -euo pipefail
scenes=/opt/masonry/scenes
if (($# == 0)) || [[ $1 == --help ]]; then
    echo "SCENE [options of the scene]: SCENE is a Python file in the mounted folder, or one of" \
        "$(cd "$scenes" && grep -l 'scene.finish()\|masonry' -- *.py | grep -v '^\(plot\|view\)\.py$' | sed 's/\.py$//' | xargs)."
    echo "Results are written to the mounted folder: results/SCENE, or where --out says."
    exit 0
fi
scene=$1
[[ -f $scene ]] || scene=$scenes/${1%.py}.py
[[ -f $scene ]] || { echo "no scene '$1' in the mounted folder, and none of the project has this name" >&2; exit 2; }
exec yade -n -x "$scene" "${@:2}"
