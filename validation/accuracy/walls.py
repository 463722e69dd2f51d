# SPDX-License-Identifier: GPL-2.0-or-later
"""The walls of the study of --accuracy: ten shapes of four kinds of masonry, of bricks of 220 × 162
mm."""

from masonry import Scene, bricks, materials
from masonry.scene import options

UNIT = (0.22, 0.102, 0.162)  # [m] length, thickness, height
_WINDOW = bricks.Opening(0.66, 0.486, 0.88, 0.648, bricks.Lintel(0.22, 0.162))

#: Shape: length and height [m], whether the top turns, vertical stress [Pa], push [mm], openings.
SHAPES = {
    "squat-clamped": (2.64, 1.944, False, 0.5e6, 6, []),
    "squat-cantilever": (2.64, 1.944, True, 0.5e6, 8, []),
    "slender-clamped": (0.88, 2.268, False, 0.7e6, 12, []),
    "slender-cantilever": (0.88, 2.268, True, 0.7e6, 12, []),
    "short-clamped": (1.32, 1.296, False, 0.6e6, 5, []),
    "short-cantilever": (1.32, 1.296, True, 0.6e6, 6, []),
    "window-clamped": (2.2, 1.782, False, 0.3e6, 5, [_WINDOW]),
    "window-cantilever": (2.2, 1.782, True, 0.3e6, 6, [_WINDOW]),
    "long-low": (3.3, 0.972, False, 0.4e6, 3, []),
    "tall-narrow": (0.66, 2.43, False, 0.5e6, 12, []),
}
#: Kinds of masonry: changes of the calcium-silicate joints, by property; None: granite with dry
#: joints.
MASONRY = {
    "silicate": {},
    "weak": {
        "cohesion": 0.5,
        "tensileStrength": 0.5,
        "modeIFractureEnergy": 0.5,
        "modeIIFractureEnergy": 0.5,
    },
    "strong": {
        "cohesion": 1.5,
        "tensileStrength": 1.5,
        "modeIFractureEnergy": 2.5,
        "modeIIFractureEnergy": 2.5,
    },
    "granite": None,
}
LOADED = 0.4  # [m] of a cantilever: the push is so far above the wall


def material(kind):
    """The materials of a kind of masonry."""
    if MASONRY[kind] is None:
        return materials.dryGranite(175, UNIT[2])
    found = materials.calciumSilicate()
    for name in ("bed", "head"):
        joint = found.joints[name]
        changed = {p: f * getattr(joint, p) for p, f in MASONRY[kind].items()}
        joint.updateAttrs(changed)
    return found


def main():
    parser = options.parser(__doc__, until=None, loops=False)
    parser.add_argument("--shape", choices=list(SHAPES), default="squat-clamped")
    parser.add_argument("--masonry", choices=list(MASONRY), default="silicate")
    args = parser.parse_args()
    length, height, turns, stress, until, openings = SHAPES[args.shape]
    wall = bricks.Wall(length, height, UNIT, openings=openings)
    if args.masonry == "granite":
        args.crack_surfaces = "off"
    scene = Scene(f"{args.shape}_{args.masonry}", wall, material(args.masonry), arguments=args)
    scene.platen("bottom")
    above = dict(rotation="free", upTo=height + LOADED) if turns else {}
    top = scene.platen("top", recorded=height, drive="x", **above)
    scene.press(top, stress)
    scene.settle(damping="local", record=False)
    scene.push(top, until)
    scene.finish()


if __name__ == "__main__":
    main()
