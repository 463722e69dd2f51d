# SPDX-License-Identifier: GPL-2.0-or-later
"""Which properties of a MasonryJoint or MasonryMat somebody has given, and which are defaults.

When this module is imported, both classes begin to note it: what is given when an object is made, set as an attribute or
with ``set`` or ``updateAttrs`` later, counts as given. ``brittleCoulomb`` and :func:`copied` keep the note. An object that
YADE has loaded from a file has none: everything counts as given.

Both classes also get ``set``, which takes properties that depend on each other together.
"""

import math
import re

from yade.wrapper import MasonryJoint, MasonryMat

from ..arguments import (
    isListed,
    isNumber,
    items,
    label,
    misfits,
    nearest,
    number,
    plain,
    vector,
)
from .blocks import properties, refuse

NOTE = "_assumed"  # in an object: sources of what was not given, by property

#: Descriptions of the properties by class and name, with the density of a unit, which is YADE's.
DESCRIBED = {
    cls: {p["name"]: p for p in properties(cls)} for cls in (MasonryJoint, MasonryMat)
}
DESCRIBED[MasonryMat]["density"] = {
    "name": "density",
    "unit": "kg/m³",
    "source": "",
    "low": 0.0,
    "high": math.inf,
}

#: Names of the properties that each law reads, the default law first.
LAWS = {law["name"]: set(law["properties"]) for law in MasonryJoint.laws()}

#: Where the default of a property is from, by class and name; the paper is that of yade_plugin/law/README.md.
DEFAULTS = {
    cls: {
        name: f"default of {cls.__name__}, for calcium silicate: {p['source'] or 'none'}"
        for name, p in described.items()
    }
    for cls, described in DESCRIBED.items()
}

#: Properties without a default that fits any masonry.
NEEDED = {
    MasonryMat: ["density"],
    MasonryJoint: ["tensileStrength", "cohesion", "friction", "compressiveStrength"],
}


def assumed(thing):
    """What nobody has given of an object: a dict of property -> source of its value."""
    return thing.__dict__.get(NOTE, {})


def state(thing, **sources):
    """Note of an object that these properties are assumed, with the source of each, and that all others are given.

    Returns the object.
    """
    thing.__dict__[NOTE] = dict(sources)
    return thing


def copied(thing):
    """Another material or joint with the same attributes and the same note."""
    made = type(thing)(**{k: v for k, v in thing.dict().items() if k != "id"})
    return state(made, **assumed(thing))


def isDefault(thing, name):
    """Whether a property has the default of its class because nobody has given it."""
    return assumed(thing).get(name) == DEFAULTS[type(thing)][name]


#: How the plugin refuses a value because of another property.
_TOGETHER = re.compile(
    "must be at most|apex of the Coulomb cone|without cohesion|too small for peak ratio"
)


def _depends(cls, name, value, message):
    """Whether an error is about how a property goes with others, and not about its own bounds."""
    p = DESCRIBED[cls].get(name)
    if p is None or not isinstance(value, (int, float)):
        return False
    within = isinstance(value, bool) or p["low"] <= value <= p["high"]
    return within and bool(_TOGETHER.search(message))


#: Properties that only another law than the default one reads, and that the class checks under that law alone: their kinds.
OF_OTHER_LAWS = {
    name: number(p["unit"].strip("-"), p["low"], p["high"])
    for law in list(LAWS)[1:]
    for name, p in DESCRIBED[MasonryJoint].items()
    if name in LAWS[law] and name not in next(iter(LAWS.values()))
}


HUGE = 1e100  # a number of a direction may not be larger


def _kindOf(name, value, usual):
    """The kind of a value that a class takes, or cannot answer in a sentence, though it means nothing; else None.

    :param usual: whether the joint follows the default law
    """
    if isinstance(value, (str, bytes)):
        return label
    if isListed(value) and (items(value) is None or name == "direction" and _isHuge(value)):  # fmt: skip
        return vector(most=HUGE)
    if name == "density" and (isinstance(value, bool) or isNumber(value) and plain(value) == math.inf):  # fmt: skip
        return number("kg/m³", 0)
    return OF_OTHER_LAWS.get(name) if usual and isNumber(value) else None


def _isHuge(value):
    """Whether one of some finite numbers is larger than the square of it can be."""
    sizes = [abs(plain(v)) for v in items(value) if isNumber(v)]
    return any(HUGE < size < math.inf for size in sizes)


def _misfits(cls, values, law=None):
    """Sentences on values of a material or a joint that mean nothing, by the names of the properties.

    :param law: of the joint, if it is there; None: the default one
    """
    chosen = values.get("law", law)
    usual = chosen is None or isinstance(chosen, str) and chosen == next(iter(LAWS))
    found = {}
    for name, value in values.items():
        kind = _kindOf(name, value, usual)
        sentences = misfits(f"{cls.__name__}: ", {name: kind}, values) if kind else []  # fmt: skip
        if sentences:
            found[name] = sentences[0]
    return found


def _unknown(cls, name):
    """The sentence on a property that a class does not have."""
    return f"{cls.__name__} has no property {name!r}{nearest(name, DESCRIBED[cls])}"


def _check(thing, values):
    law = getattr(thing, "law", None)
    refuse([*_misfits(type(thing), values, law).values()])


def _note(cls):
    """Let a class note what is given."""
    make, setOne, setMany = cls.__init__, cls.__setattr__, cls.updateAttrs

    def __init__(self, *args, **values):
        unknown = [n for n in values if not hasattr(cls, n)]
        problems = [_unknown(cls, n) for n in unknown]
        wrong = [*_misfits(cls, values).values()]
        if problems and not wrong:  # as of any other class of the plugin
            raise AttributeError("\n".join(problems))
        refuse([*problems, *wrong])
        make(self, *args, **values)
        state(self, **{n: s for n, s in DEFAULTS[cls].items() if n not in values})

    def __setattr__(self, name, value):
        _check(self, {name: value})
        try:
            setOne(self, name, value)
        except ValueError as error:
            if not _depends(cls, name, value, str(error)):
                raise
            raise ValueError(
                f"{error}; properties that depend on each other are set together, as in joint.set({name}=..., ...)"
            ) from None
        assumed(self).pop(name, None)

    def updateAttrs(self, values):
        _check(self, values)
        setMany(self, values)
        for name in values:
            assumed(self).pop(name, None)

    def setTogether(self, **values):
        known = self.dict()
        problems = []
        for name in values:
            if name not in known:
                problems.append(_unknown(cls, name))
        known = {n: v for n, v in values.items() if n in known}
        wrong = _misfits(cls, known, getattr(self, "law", None))
        problems += wrong.values()
        if not problems:
            self.updateAttrs(values)
            return self
        try:  # the other problems, of a copy
            copied(self).updateAttrs({n: v for n, v in known.items() if n not in wrong})  # fmt: skip
        except ValueError as error:
            problems.append(str(error))
        raise ValueError("\n".join(problems))

    __init__.__doc__ = (
        "Properties are keyword arguments; what is not given has its default."
    )
    updateAttrs.__doc__ = setMany.__doc__
    setTogether.__name__, setTogether.__qualname__ = "set", f"{cls.__name__}.set"
    setTogether.__doc__ = """Set properties together: set(friction=0.6, residualFriction=0.6).

    They are checked together, as values that depend on each other must be. If something is wrong, the error has all
    problems, and the object stays as it was. Returns the object.
    """
    cls.__init__, cls.__setattr__ = __init__, __setattr__
    cls.updateAttrs, cls.set = updateAttrs, setTogether


def _noteBrittle():
    """Let the brittle joint have the note of the joint that it is made from; its tables and its cap are given."""
    make = MasonryJoint.brittleCoulomb

    def brittleCoulomb(self):
        made = make(self)
        chosen = ("tensionTable", "shearTable", "cap")
        return state(
            made, **{n: s for n, s in assumed(self).items() if n not in chosen}
        )

    brittleCoulomb.__doc__ = make.__doc__
    MasonryJoint.brittleCoulomb = brittleCoulomb


for _cls in (MasonryJoint, MasonryMat):
    _note(_cls)
_noteBrittle()
