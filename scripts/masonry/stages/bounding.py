# SPDX-License-Identifier: GPL-2.0-or-later
"""Commands of a scene that ask for limit analysis, which the wing masonry_limit carries out."""

from typing import Annotated, Any

from ..arguments import Direction, Level, Numbers, listOf, number, validated
from ..model.bodies import vector
from ..errors import Interrupted, Refused
from .. import wings
from ..model.load_names import nameInDomain, nameOfLean, nameOfPush
from .bounds import findBy
from ..scene.resuming import saidBefore
from . import gravity
from .push import Pushed, patternOf
from ..scene.targets import MovingPlaten
from ..scene.script import asData


@validated
def bound(
    scene: Any,
    target: Pushed | None = None,
    direction: Direction = (1, 0, 0),
    towards: Level | None = None,
) -> Any:
    """Limit analysis of the scene as it stands, with a collapse without dilatancy: see
    :mod:`masonry_limit`. Stages that push or lean find their bound by themselves, if there are at
    most 3000 joints; this is for other loads, and for larger structures.

    :param target: what is pushed, or a pattern, as in :meth:`push`, along ``direction``; its factor
        is the force of the push [kN]
    :param towards: horizontal direction of an acceleration, whose factor is in g; give this or
        ``target``
    :returns: the entry of run.json: a dict with what :mod:`masonry.run.results` lists
    """
    if (target is None) == (towards is None):
        raise Refused("bound: give either target or towards")
    wings.find("bound")

    def find():
        before = saidBefore(scene, "bound", target=asData(target) or "")
        if target is not None:
            along = vector(direction, "bound: direction").normalized()
            pushed = patternOf(scene, target, along, scene.args)
            name, load = nameOfPush(pushed, along), ("push", pushed, along)
        else:
            along = gravity.sideways(scene, towards, "bound")
            name, load = nameOfLean(along), ("lean", along)
        known = scene.bounds.entries.get(name)
        return known if before and known else findBy(scene, *load, lowerUpTo=scene.bounds.EVERY)

    return _inOrder(scene, find, bound, target, direction, towards)


@validated
def domain(
    scene: Any,
    target: MovingPlaten,
    normal: Annotated[Numbers, listOf(number("kN", 0, 1e9, above=True))],
    direction: Level = (1, 0, 0),
) -> list[dict[str, Any]]:
    """The N-V domain of a pier: limit analysis of a push under several normal forces, which replace
    the vertical force on the platen there alone. :func:`masonry_capacity.domain` reads it, and
    ``/usr/bin/python3 -m masonry_capacity --domain`` draws it, with the peaks of runs as points.

    :param target: a platen that is pushed, with a :meth:`press` that says where the normal force
        acts
    :param normal: forces with which the platen presses on what is below, its weight included: a
        list [kN]
    :param direction: of the push, horizontal
    :returns: the entries of run.json: a list of dicts as in :meth:`bound`, with ``pressed_kN``, the
        force that was given, and ``normal_kN``, the force at the supports, with the weight of what
        is above them
    :raises ValueError: if the platen is not pressed, or is held along z
    """
    wings.find("domain")
    if target.pressed is None:
        raise Refused(
            f"domain: {target.name} is not pressed: press({target.name}, ...) before the first"
            " stage says where the normal force acts"
        )

    def find():
        isDriven = scene.model.loading.isDriven(target, "z")
        if "z" in (target.freedom or "") or isDriven:
            raise Refused(
                f"domain: {target.name} is held along z, so its normal force is no load that could"
                " be replaced"
            )
        before = saidBefore(scene, "domain", target=target.name, normal=list(normal))
        along = vector(direction, "domain: direction").normalized()
        names = [nameInDomain(target, along, one) for one in normal]
        known = [*map(scene.bounds.entries.get, names)]
        if before and all(known):
            return known
        return findBy(scene, "domain", target, normal, along, lowerUpTo=scene.bounds.SMALL)

    return _inOrder(scene, find, domain, target, normal, direction)


def _inOrder(scene, find, command, *arguments):
    """What a function finds of a scene that is built, noted as a command of the script."""
    try:
        with scene.noted(command, *arguments), scene.running.listening():
            scene.begin()
            scene.bounds.take(True)
            if scene.collapsed:
                raise Refused(
                    f"{command.__name__}: the structure has fallen; stepBack() goes back to its"
                    " last state at rest"
                )
            return find()
    except Interrupted as error:
        return scene.failed(error)
