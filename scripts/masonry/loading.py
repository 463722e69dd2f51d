"""Stages of a test. Each is a function of a run and a model; what it must remember is a dataclass of its own."""

from dataclasses import dataclass

from yade import O, Vector3

from .errors import Refused
from .progress import say

RAMP = 0.02  # [s] in which loads and velocities grow: some ten periods of a wave through the height of a wall
SETTLING = 0.5  # local damping of deformable units before the push: with more they creep to rest, with less they swing
REST = 5e-3  # of the vertical load: what may be missing at the base when a wall is said to be at rest
ROW_EVERY = 0.01  # [mm] of a push between rows of curve.csv
IMBALANCE = 0.1  # a push with a larger dynamic imbalance is too fast: its peak is off by 1 to 5 % and more
ROWS = 2000  # of curve.csv while a block is driven over a distance


def ramp(args):
    """Time in which loads and velocities grow [s]: waves in heavier blocks are slower."""
    return RAMP * args.density_scaling**0.5


# -- settle -----------------------------------------------------------------------------------------------------------


@dataclass
class Settling:
    """What :func:`settle` remembers."""

    done: int = 0  # steps so far
    quiet: int = 0  # checks in a row that found the wall at rest


def settle(run, model):
    """Gravity, and a vertical load that grows smoothly, until a wall is at rest.

    The precompression is what the top course feels: the weight of the loading block is part of it. At rest the base
    carries what is above it but for the share REST, and hardly anything moves; the damping of the push takes the rest.
    """
    at = run.stage("settle", Settling())
    if at is None:
        return
    vertical, base = model.loads["vertical"], model.blocks["base"]
    weight = model.weight()
    force = model.verticalForce()
    if model.zones:
        model.damp(min(SETTLING, run.args.damping), "local")
    growing = int(ramp(run.args) / O.dt)
    most = int(10 * ramp(run.args) / O.dt)
    while at.done < most and at.quiet < 3:
        x = min(1, (at.done + 100) / growing)
        vertical.force = Vector3(0, 0, -force * x * x * (3 - 2 * x))
        run.advance(100)
        at.done += 100
        energy = model.energy.balance()
        elastic = (
            energy["elastic_compression"]
            + energy["elastic_shear"]
            + energy["elastic_tension"]
            + energy["elastic_units"]
        )
        carried = O.forces.f(base, True)[2]
        missing = 1 + carried / (weight - vertical.force[2])
        moving = abs(energy["kinetic"])
        rests = abs(missing) < REST and moving < 1e-5 * elastic
        at.quiet = at.quiet + 1 if rests and x == 1 else 0
        run.show(
            at.done / most,
            lambda: f"unbalanced {100 * missing:+.2f} %, kinetic/elastic {moving / elastic:.1e}",
            at.quiet == 3,
        )
        if model.hasSunk():
            run.collapsed = True
            say("the wall has collapsed before the push")
            return
    if at.quiet < 3:
        say(f"note: the wall is not quite at rest after {run.at.steps} steps")


# -- push -------------------------------------------------------------------------------------------------------------


@dataclass
class Pushing:
    """What :func:`push` remembers."""

    origin: list = None  # displacement of the loading block when the push began, along it and up [m]
    began: float = 0.0  # time then [s]
    moved: float = 0.0  # displacement since then [mm]
    peak: float = 0.0  # largest base shear so far [kN]
    peakAt: float = 0.0  # displacement there [mm]
    nextFrame: float = 0.0  # displacement at which the next ParaView frame is due [mm]


def push(run, model):
    """Drive the loading block sideways at a steady velocity, to ``--until`` or to collapse, with rows and frames.

    A wall has collapsed if the loading block has come down by half a course, or if a millimetre after the peak less than
    a fifth of it is left.
    """
    args, at = run.args, run.stage("push", Pushing())
    if at is None or run.collapsed:
        return
    if not args.until > at.moved:
        raise Refused(
            f"--until {args.until:g}: the run is at {at.moved:.2f} mm already"
        )
    load, growing = model.loads["push"], ramp(args)
    every = max(1, int(ROW_EVERY / (args.rate * O.dt)))
    if at.origin is None:
        at.origin, at.began = list(model.topDisplacement()), O.time
        model.origin = at.origin
        at.moved = 1e3 * run.record().along
        run.frame()
        at.nextFrame = args.vtk_every
    model.origin = at.origin
    model.damp(args.damping, args.damping_kind)
    detail = lambda: f"{at.moved:6.2f} of {args.until:g} mm  {shear:7.2f} kN"
    now, stretch, velocity = O.time, every * O.dt, None
    while at.moved < args.until and not run.collapsed:
        growth = min(1.0, (now - at.began + stretch) / growing)
        if velocity != args.rate * 1e-3 * growth:
            velocity = load.velocity = args.rate * 1e-3 * growth
        model.keepLoadLine()
        run.advance(every)
        reading = run.record()
        now, at.moved = reading.time, 1e3 * reading.along
        shear = 1e-3 * reading.baseShear
        if shear > at.peak:
            at.peak, at.peakAt = shear, at.moved
        lost = at.moved > at.peakAt + 1 and shear < 0.2 * at.peak
        run.collapsed = lost or model.hasSunk(reading.sunk)
        run.show(max(0, at.moved / args.until), detail)
        goesOn = at.moved < args.until and not run.collapsed
        if goesOn and at.moved >= at.nextFrame:
            run.frame()
            at.nextFrame += args.vtk_every
    run.show(1, detail, final=True)
    run.flush()
    if run.collapsed:
        say(f"the wall has collapsed at {at.moved:.2f} mm")


def tooFast(args, imbalance):
    """The warning of a push that is too fast, with what would do: the imbalance grows with the rate at least."""
    slower = f"--rate {float(f'{args.rate * IMBALANCE / imbalance:.2g}'):g}"
    cure = "--damping-kind combined" if args.damping_kind == "local" else slower
    return (
        f"warning: the push is too fast: {100 * imbalance:.0f} % of the force does not reach the base, "
        f"more than {100 * IMBALANCE:.0f} % spoil the peak; {cure} would do"
    )


# -- drive ------------------------------------------------------------------------------------------------------------


@dataclass
class Driving:
    """What :func:`drive` remembers."""

    length: int = 0  # steps in all
    done: int = 0  # steps so far


def drive(run, model, name, distance):
    """Drive a load over a distance at ``--rate``, with rows. Other loads keep what they do.

    The rows are closer together at the beginning, where the peaks are.

    :param name: label of the load
    :param distance: along the direction of the load [m]
    """
    at = run.stage(name, Driving())
    if at is None:
        return
    load = model.loads[name]
    if not at.length:
        speed = run.args.rate * 1e-3
        at.length = max(ROWS, int(abs(distance) / (speed * O.dt)))
        load.velocity = distance / (at.length * O.dt)
    marks = {round(at.length * (i / ROWS) ** 2) for i in range(1, ROWS + 1)}
    for mark in sorted(marks):
        if mark <= at.done:
            continue
        run.advance(mark - at.done)
        at.done = mark
        reading = run.record()
        run.show(at.done / at.length, lambda: model.brief(reading))
    run.flush()
    load.velocity = 0
