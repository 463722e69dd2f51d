# SPDX-License-Identifier: GPL-2.0-or-later
"""The twelve earthquakes of ``reference/``, and what the studies beside this file share."""

import glob
import itertools
import os

from masonry_study import Study

HERE = os.path.dirname(os.path.abspath(__file__))
EVERY = 0.005  # [s] between samples, as reference/README.md says
#: Levels of the peak ground acceleration [g], the geometric mean of both horizontal components.
LEVELS = [0.35, 0.5, 0.7, 1.0, 1.4, 2.0]


def triples():
    """The files of every earthquake: both horizontal components in the order of their names, then
    the vertical one."""
    files = sorted(
        glob.glob(os.path.join(HERE, "reference", "*.acc")),
        key=lambda f: (event(f), f.endswith("_UD.acc"), f),
    )
    return [tuple(group) for _, group in itertools.groupby(files, event)]


def event(path):
    """What the names of the files of an earthquake begin with."""
    return os.path.basename(path).rpartition("_")[0]


def study(scene, levels=None, **options):
    """The incremental dynamic analysis of a scene of this folder."""
    return Study(
        scene,
        design="ida",
        records=triples(),
        levels=levels or LEVELS,
        unit="m/s²",
        every=EVERY,
        options={"points": 5, **options},
    )
