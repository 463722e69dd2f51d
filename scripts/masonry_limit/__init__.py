# SPDX-License-Identifier: GPL-2.0-or-later
"""Limit analysis: the largest load that a structure of rigid blocks can carry, without a run.

The blocks and joints are those of the scene that is built, so this is a second opinion on what a
run says::

    import masonry_limit as limit

    assembly = limit.read()                              # the scene as it stands in YADE
    dead = assembly.weights((0, 0, -9.81))               # [m/s²]
    live = assembly.weights((9.81, 0, 0))                # so the factor is in g
    bound = assembly.largest(live, dead)
    print(bound.sentence("horizontal acceleration", "g"))
    bound.save("results")                                # python3 -m masonry_view.figures results

Of a :class:`masonry.Scene` ``scene.bound(...)`` does all this.

The static theorem is used: the largest factor for which forces in the joints exist that are in
equilibrium with the loads and nowhere above the strength. It is a linear programme, which the
interior-point method of Clp solves, in a process of its own that can be ended
(:mod:`masonry_limit.solver`). Its dual is the mechanism: how fast each block moves when the
structure gives way (Livesley, "Limit analysis of structures formed from rigid blocks",
International Journal for Numerical Methods in Engineering 12, 1978).

What it takes for granted:

- Blocks are rigid and keep their strength; displacements until the collapse are small.
- Joints are rigid and perfectly plastic, with the strengths that they have before anything softens:
  tensile strength, cohesion, friction, and, where they can crush, the compressive strength. Points
  of a joint are those of the engine, so strength in bending is that of the engine's joint, too. The
  elliptical end of the cap is left out.
- Joints that slip open as friction tells (associated flow). Real ones do not, and can carry less.

So the factor is an **upper bound** for joints that soften and slip. For dry joints of which none
slips in the mechanism it is what rigid blocks carry, if the joints close no loops, as those of an
arch, a stack or a panel. In running bond, head joints that are open slip freely, and a wall can tip
over a stepped crack at a lower factor; where that is found,
:attr:`Bound.weaker` has it. :meth:`Assembly.withoutDilatancy` looks for a collapse of joints that
slip without opening, which lies below.

Friction in space is a polygon around the circle, :data:`FACETS` sides a point. At every point it is
turned to where the force there points, as long as that lowers the factor. :attr:`Bound.facetError`
is how much the last turn changed the factor.
"""

from masonry.wings import folderOf

__path__ = folderOf(__name__)

from .assembly import Assembly
from .bound import MECHANISM, SHOWN, Bound
from .programme import FACETS
from .reading import read

__all__ = ["FACETS", "MECHANISM", "SHOWN", "Assembly", "Bound", "read"]
