# SPDX-License-Identifier: GPL-2.0-or-later
"""Capacity for engineers: bilinear curves, the demand of an earthquake, and N-V domains, from the
files of runs.

On the command line::

    /usr/bin/python3 -m masonry_capacity results/wall_comp4
    /usr/bin/python3 -m masonry_capacity results/wall_comp4 --mass 30e3 --gamma 1 \\
        --type 1 --ground B --ag 0.15g
    /usr/bin/python3 -m masonry_capacity --domain results/pier results/pier_100 results/pier_200

and in Python, also where there is no YADE::

    import masonry_capacity as capacity

    curve = capacity.bilinearOf("results/wall_comp4", rule="en1998")
    system = capacity.equivalent(mass=30e3, gamma=1.0)                      # [kg], [-]
    spectrum = capacity.elastic(ag=0.15, unit="g", type=1, ground="B")
    found = capacity.demand(curve, system, spectrum)
    found.targetDisplacement, found.ductility, found.holds, found.verdict()

- :mod:`masonry_capacity.bilinear_curve`: the bilinear curve of a push, and its drifts
- :mod:`masonry_capacity.spectra`: elastic spectra of EN 1998-1:2004, and from files
- :mod:`masonry_capacity.n2`: the equivalent system, and the target displacement by the N2 method
- :mod:`masonry_capacity.domains`: the N-V domain of a pier, with runs as points
- :mod:`masonry_capacity.piers`: piers of a run by EN 1998-3:2005 and NTC 2018
- :mod:`masonry_capacity.panels`: panels out of their plane by AS 3700
- :mod:`masonry_capacity.report`: the files of all that, which :mod:`masonry_capacity.figure` draws

**What the equivalent system is.** The structure is one mass on a spring: it moves in one shape,
that of the push, and keeps that shape after it yields. The spring is the bilinear curve of the
push. The mass m* and the factor Γ are those of the structure in an earthquake, not of the test: a
wall that is pushed at its top holds back the mass of the floors that move with its top, and a share
of its own. With all of it at the height of the loaded point Γ is 1. Whether the mass that presses
the wall in a test also moves with it is for the user to say. So neither is guessed: they are given,
or the script of the run says them by ``scene.result``.

**What the demand is not.** Annex B has the relation of ductility and force of structures whose
loops take energy; rocking walls take less. Torsion, walls that fall out of their plane, and the
change of the stiffness by the cycles of an earthquake are not in it.
"""

from masonry.wings import folderOf

__path__ = folderOf(__name__)

from .bilinear_curve import Bilinear, Pushover, bilinear, drifts, pushover
from .bilinear_curve import ofRun as bilinearOf
from masonry.numbers.quantities import Number
from .n2 import Demand, Equivalent, demand, equivalent, iterated, ofMasses, ofRun
from .domains import BoundPoint, Domain, RunPoint, domain, runPoint
from .panels import panelPressure
from .report import assess, assessDomain
from .spectra import Spectrum, elastic, readSpectrum

__all__ = [
    "Bilinear",
    "BoundPoint",
    "Demand",
    "Domain",
    "Equivalent",
    "Number",
    "Pushover",
    "RunPoint",
    "Spectrum",
    "assess",
    "assessDomain",
    "bilinear",
    "bilinearOf",
    "demand",
    "domain",
    "drifts",
    "elastic",
    "equivalent",
    "iterated",
    "ofMasses",
    "ofRun",
    "panelPressure",
    "pushover",
    "readSpectrum",
    "runPoint",
]
