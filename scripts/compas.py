# SPDX-License-Identifier: GPL-2.0-or-later
"""A problem of compas_dem under its weight and loads until it is at rest, with results in a file
that compas_dem reads.

    yade -n -x scripts/compas.py DEM_problem.json DEM_results.json

Horizontal body forces come after other loads, displacements of supports last. It takes some 3 s.
"""

import math

from masonry import AT_REST, Scene
from masonry.scene.compas_problems import readProblem
from masonry.scene.compas_results import writeResults
from masonry.scene.options import parser
from masonry.units import GRAVITY

MISSING = 1e-3  # share of the loads that supports do not carry at rest, at most


def rest(scene):
    for _ in range(20):
        if scene.settle() != AT_REST or scene.model.supports.unrest()[0] < MISSING:
            return


def main(words=None):
    options = parser(__doc__, until=None)
    options.add_argument("problem", help="file of a Problem of compas_dem")
    options.add_argument("results", help="file that is written")
    args = options.parse_args(words)
    try:
        problem = readProblem(args.problem, args.results)
    except ValueError as error:
        options.error(str(error))
    of = dict(gravity=problem.gravity, plane=False, arguments=args, **problem.options)
    scene = Scene("compas", problem.bricks, problem.masonry, **of)
    held = {n: scene.hold(n, f"held_{n}", axes) for n, axes in problem.held.items()}
    for k, (n, force, point) in enumerate(problem.loads):
        loaded = scene.handle(n, f"load_{k}")
        loaded.point = point or loaded.point
        scene.load(loaded, force)
    rest(scene)
    if sideways := math.hypot(*problem.body[:2]):
        scene.lean(sideways / GRAVITY, towards=(*problem.body[:2], 0))
        rest(scene)
    if problem.moved:
        paths = {held[n].recorded: path for n, path in problem.moved.items()}
        along = [lambda *at, i=i: 1e3 * paths[at][i] for i in range(3)]
        scene.move([held[n] for n in problem.moved], *along)
        rest(scene)
    if scene.ended == AT_REST:
        writeResults(args.results, problem, scene)
    else:
        print(f"note: the structure is not at rest, so {args.results} is not written")
    scene.finish()


if __name__ == "__main__":
    main()
