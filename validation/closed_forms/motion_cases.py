# SPDX-License-Identifier: GPL-2.0-or-later
"""Motion: free fall, sliding and rocking blocks, restitution, momentum, rotation, viscous damping,
work of gravity."""

import math

from cases import between, case
from masonry import (
    MasonryJoint,
    MasonryMat,
    MasonryZones,
    addBlock,
    bricks,
    connect,
    criticalTimeStep,
    engine,
    engines,
)
from masonry.bricks import boxCorners as corners
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq
from structures import G, box, dry, elastic, fix, mat, rigidlike, sceneOf
from yade import O, Quaternion, Vector3

FALL, SLIDE, ROCK = "Flight", "Newmark's sliding block", "Housner's rocking block"
DAMPED = "Damping and work"
NEWMARK = "½·A·g·t0²·(A/μ − 1), Newmark 1965"
HOUSNER = "integral of the motion; Housner 1963 for small α"
UNIT = (0.22, 0.102, 0.081)  # [m]


def go(seconds):
    """Take steps for a time, at least one."""
    for _ in range(max(1, round(seconds / O.dt))):
        O.step()


# -- flight ----------------------------------------------------------------------------------------


def fly(deformable):
    """Way of a brick that falls freely for 0.2 s: expected and measured [m]."""
    O.reset()
    unit = MasonryMat(density=1800, young=4.8e8, poisson=0.16)
    body = addBlock(corners((0, 0, 0), UNIT), unit)
    zones = MasonryZones(bodies=[body], damping=0) if deformable else None
    engines([MasonryJoint()], damping=0, zones=zones)
    O.dt = 0.5 * criticalTimeStep()[0] if deformable else 1e-4
    go(0.02 if deformable else 0.2)
    state = O.bodies[body].state
    # velocities are half a step behind, so that the way from rest is that of one step more
    return 0.5 * G * O.time * (O.time + O.dt), state.refPos[2] - state.pos[2]


@case(
    FALL,
    "way of a rigid brick in 0.2 s [m]",
    "½·g·t·(t + Δt), exact in steps",
    aim=1e-9,
    quick=True,
)
def fall_rigid(quick):
    return fly(False)


@case(
    FALL,
    "way of a deformable brick in 0.02 s [m]",
    "½·g·t·(t + Δt), exact in steps",
    aim=0.005,
    quick=True,
)
def fall_deformable(quick):
    return fly(True)


def flyingStack(deformable=False):
    """A stack of three bricks, free in space, that flies, turns and swings in its elastic
    joints."""
    O.reset()
    unit = MasonryMat(density=1800, young=4.8e9, poisson=0.16)
    bodies = []
    for k in range(3):
        low, high = (0, 0, k * UNIT[2]), (*UNIT[:2], (k + 1) * UNIT[2])
        bodies.append(addBlock(corners(low, high), unit))
    engines([elastic(1e10)], damping=0, gravity=(0, 0, 0))
    connect()
    O.dt = 0.2 * criticalTimeStep()[0]
    for k, body in enumerate(bodies):
        O.bodies[body].state.vel = Vector3(0.3 + 0.01 * k, -0.2, 0.5 - 0.02 * k)
    return [O.bodies[b].state for b in bodies]


@case(
    FALL,
    "momentum of a stack of three that swings in flight, after 2000 steps [kg m/s]",
    "conserved",
    aim=1e-9,
    quick=True,
)
def flight_momentum(quick):
    states = flyingStack()
    momentum = lambda: sum((s.mass * s.vel for s in states), Vector3.Zero)
    before = momentum()
    go(2000 * O.dt)
    return before.norm(), before.norm() + (momentum() - before).norm()


@case(
    FALL,
    "energy of the same stack, kinetic and elastic [J]",
    "conserved",
    aim=1e-3,
    quick=True,
)
def flight_energy(quick):
    states = flyingStack()
    before = sum(0.5 * s.mass * s.vel.squaredNorm() for s in states)
    go(2000 * O.dt)
    balance = engine("energy").balance()
    kept = [v for k, v in balance.items() if k.startswith(("kinetic", "elastic"))]
    return before, sum(kept)


def turned(degrees):
    """Largest stress in joints of a stack that turns as one rigid body [Pa], with what a hundredth
    of a turn of one block against the next would make."""
    O.reset()
    for k in range(3):
        box((0, 0, k * 0.1), (0.2, 0.1, 0.1), mat())
    engines([elastic(1e10)], damping=0, gravity=(0, 0, 0))
    made = connect()
    O.dt = 0.2 * criticalTimeStep()[0]
    axis, middle = Vector3(1, 2, 2) / 3, Vector3(0.1, 0.05, 0.15)
    parts = round(degrees / 5)
    for _ in range(parts):  # axes of joints follow small turns
        turn = Quaternion(axis, math.radians(degrees / parts))
        for body in O.bodies:
            s = body.state
            s.pos, s.ori = middle + turn * (s.pos - middle), turn * s.ori
            s.vel = s.angVel = Vector3.Zero
        O.step()
    worst = max(Vector3(*m).norm() for i in made for m in i.phys.stress)
    return worst / (1e10 * 0.2 * 0.01 * 2 * math.pi)


@case(
    FALL,
    "stress in a stack turned by 90° in space, over that of a joint turned by 3.6° [-]",
    "0",
    aim=1e-9,
    absolute=True,
    quick=True,
)
def turned_90(quick):
    return 0.0, turned(90)


@case(FALL, "the same, turned by 720°", "0", aim=1e-9, absolute=True, quick=True)
def turned_720(quick):
    return 0.0, turned(720)


# -- sliding and rocking ---------------------------------------------------------------------------


def newmark(friction, pulse, lasts, stiffness=1e12):
    """Slide of a block under a rectangular pulse [g] on its ground: expected and measured [mm]."""
    masonry = rigidlike(friction, stiffness)
    with sceneOf(bricks.stack(1, (1.0, 0.5, 0.1)), masonry) as s:
        s.platen("bottom"), s.watch(0, name="block")
        s.settle()
        every = 1e-4
        record = [pulse * G] * (round(lasts / every) + 1) + [0.0]
        s.shake(record, every, after=0.4)
        slide = 500 * pulse * G * lasts**2 * (pulse / friction - 1)
        return slide, -min(s.results.column("block_x_mm"))


@case(SLIDE, "slide [mm], μ = 0.3, 0.5 g for 0.2 s", NEWMARK, aim=0.005, quick=True)
def newmark_long(quick):
    return newmark(0.3, 0.5, 0.2)


@case(SLIDE, "slide [mm], μ = 0.5, 1 g for 0.1 s", NEWMARK, aim=0.005, quick=True)
def newmark_short(quick):
    return newmark(0.5, 1.0, 0.1)


B, H = 0.25, 1.0  # of the rocking block [m]


def standing(share, stiffness=1e10, size=(B, H), fraction=0.4, restitution=1.0, points=None):
    """A free block on a fixed one, turned about its edge by a share of its slenderness angle;
    returns its state."""
    O.reset()
    width, height = size
    fix(box((-1, 0, -0.2), (2 + width, 0.25, 0.2), mat()))
    block = box((0, 0, 0), (width, 0.25, height), mat(), inPlane=True)
    engines(
        [dry(stiffness, friction=5, restitution=restitution)],
        damping=0,
        subcontacts=points,
    )
    connect()
    engine("joints").impacts = True
    engine("joints").points = points or 0
    O.dt = fraction * criticalTimeStep()[0]
    turn = Quaternion(Vector3(0, 1, 0), share * math.atan2(width, height))
    state, edge = O.bodies[block].state, Vector3(width, 0.125, 0)
    state.pos, state.ori = edge + turn * (state.pos - edge), turn * state.ori
    return state


def angle(state):
    """Rotation of a block about y [rad]."""
    return math.asin((state.ori * Vector3(0, 0, 1))[0])


def quarter(share, stiffness=1e10):
    """Time from rest until a rocking block stands upright: expected and measured [s].

    What is expected is the integral over the angle at which the block stands, without a small
    angle: Housner's acosh(1/(1 − θ0/α))/p takes that of the slenderness for small.
    """
    alpha, p = math.atan2(B, H), math.sqrt(0.75 * G / (0.5 * math.hypot(B, H)))
    from0 = lambda lean: math.cos(alpha - share * alpha) - math.cos(alpha - lean)
    # with lean = θ0·(1 − x²) the integrand has no pole where the block is at rest
    slow = lambda x: share * alpha * 2 * x / math.sqrt(2 * from0(share * alpha * (1 - x * x)))
    expected = quad(slow, 0, 1)[0] / p
    state = standing(share, stiffness)
    last = angle(state)
    while angle(state) > 0 and O.time < 2 * expected:
        last = angle(state)
        O.step()
    now = angle(state)
    return expected, O.time - O.dt * now / (now - last)


@case(ROCK, "quarter period [s], 0.25 × 1 m, θ0/α = 0.25", HOUSNER, aim=0.005, quick=True)
def rocking_25(quick):
    return quarter(0.25)


@case(ROCK, "quarter period [s], 0.25 × 1 m, θ0/α = 0.5", HOUSNER, aim=0.005, quick=True)
def rocking_50(quick):
    return quarter(0.5)


@case(ROCK, "quarter period [s], 0.25 × 1 m, θ0/α = 0.75", HOUSNER, aim=0.005)
def rocking_75(quick):
    return quarter(0.75)


def restitution(size, stiffness=1e10, **joint):
    """Angular velocity after the first impact over that before it [-]: of rigid blocks, and
    measured.

    Both velocities follow from the energy of the block at rest, before the impact and at the
    largest angle after it.
    """
    alpha, share = math.atan2(*size), 0.5
    state = standing(share, stiffness, size, **joint)
    p = math.sqrt(0.75 * G / (0.5 * math.hypot(*size)))
    farthest, most = 0.0, 4 * math.acosh(1 / (1 - share)) / p
    swung = -0.05 * alpha  # beyond the vibrations of the impact
    while O.time < most and (farthest > swung or angle(state) < 0.9 * farthest):
        O.step()
        farthest = min(farthest, angle(state))
    spin = lambda lean: math.sqrt(2 * (math.cos(alpha - lean) - math.cos(alpha)))
    return 1 - 1.5 * math.sin(alpha) ** 2, spin(-farthest) / spin(share * alpha)


RIGID = "1 − 1.5·sin²α: rigid blocks, conserved angular momentum; Housner 1963"


def impact(name, size, aim=0.02, points=3, of=0.0):
    """A case of the restitution at the first impact, with joints that have this restitution and as
    many points."""
    what = (
        f"restitution at the first impact, {size[0]} × {size[1]:g} m, {points} points, joint"
        f" restitution {of:g}"
    )
    measure = lambda quick: restitution(size, restitution=of, points=points)
    measure.__name__ = name
    case(ROCK, what, RIGID, aim=aim, quick=True)(measure)


impact("restitution_squat", (0.25, 0.5))
impact("restitution_slender", (0.25, 1.0))
impact("restitution_thin", (0.25, 2.0))
impact("restitution_8_points", (0.25, 1.0), points=8)
impact("restitution_elastic", (0.25, 1.0), aim=None, of=1.0)


def housnerFalls(pulse, lasts, kept):
    """Whether a rigid block on a rigid base turns over under a ground acceleration, with so much of
    its spin kept at an impact: Housner's equation of motion.

    :param pulse: ground acceleration [m/s²] as a function of time, none after it has lasted
    """
    alpha, p2 = math.atan2(B, H), 0.75 * G / (0.5 * math.hypot(B, H))
    end = lasts + 3.0

    def rates(t, y):
        side = math.copysign(1.0, y[0] or y[1] or -pulse(t))
        about = alpha * side - y[0]
        push = pulse(t) / G if t < lasts else 0.0
        return [y[1], -p2 * (math.sin(about) + push * math.cos(about))]

    meets, over = lambda t, y: y[0], lambda t, y: abs(y[0]) - 0.5 * math.pi
    meets.terminal = over.terminal = True
    # it leaves its base when the ground is fast enough, and is upright again at every impact
    t = brentq(lambda t: pulse(t) - G * B / H, 0, 0.25 * lasts)
    y = [-1e-9, 0.0]
    while t < end:
        meets.direction = -math.copysign(1.0, y[0])
        found = solve_ivp(
            rates, (t, end), y, events=(meets, over), max_step=0.002, rtol=1e-8, atol=1e-10
        )
        if len(found.t_events[1]):
            return True
        spin = kept * found.y[1][-1]
        if abs(spin) < 1e-3:
            return False
        t, y = found.t[-1], [math.copysign(1e-9, spin), spin]
    return False


def turnsOver(pulse, lasts, of):
    """The same of a block on a joint with this restitution."""
    state = standing(0, 1e11, restitution=of, points=3)
    integrator = engine("integrator")
    integrator.damping = 0.3
    go(0.02)
    integrator.damping, begun = 0, O.time
    while O.time < begun + lasts + 3:
        at = O.time - begun + 0.5 * O.dt
        integrator.gravity = Vector3(-pulse(at) if at < lasts else 0, 0, -G)
        O.step()
        if abs(angle(state)) > 1:
            return True
    return False


def overturning(wave, lasts, of, quick):
    """Amplitude of a pulse that turns a block over [g], of Housner's equation and measured.

    :param wave: of the time over that of the pulse
    """
    pulse = lambda a: lambda t: a * G * wave(t / lasts)
    alpha = math.atan2(B, H)
    kept = 1 - 1.5 * math.sin(alpha) ** 2 if of == 0 else 1.0
    low, high = 1.01 * B / H, 2.0
    while high - low > 1e-4:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if housnerFalls(pulse(middle), lasts, kept) else (middle, high)
    stays = lambda a: not turnsOver(pulse(a), lasts, of)
    return low, between(stays, low, 0.02, quick, spread=0.1)


SINE, HALF = lambda x: math.sin(2 * math.pi * x), lambda x: math.sin(math.pi * x)
EQUATION = "Housner's equation of motion, an impact keeps 1 − 1.5·sin²α of the spin"


@case(ROCK, "full sine of 0.4 s that turns 0.25 × 1 m over [g]", EQUATION, aim=0.02)
def overturning_long(quick):
    return overturning(SINE, 0.4, 0.0, quick)


@case(ROCK, "full sine of 0.25 s that turns it over [g]", EQUATION, aim=0.02)
def overturning_short(quick):
    return overturning(SINE, 0.25, 0.0, quick)


@case(ROCK, "half sine of 0.3 s that turns it over, without an impact [g]", EQUATION, aim=0.01)
def overturning_half(quick):
    return overturning(HALF, 0.3, 0.0, quick)


@case(
    ROCK,
    "full sine of 0.4 s that turns it over, joint restitution 1 [g]",
    "Housner's equation of motion, all of the spin kept",
)
def overturning_elastic(quick):
    return overturning(SINE, 0.4, 1.0, quick)


# -- damping and work ------------------------------------------------------------------------------


def oscillator(joint=None, blocked="xyXYZ", gravity=(0, 0, 0), zones=False, inPlane=False):
    """A brick on a fixed one, with its angular frequency along z [1/s]."""
    O.reset()
    unit = MasonryMat(density=1800, young=4.8e9, poisson=0.16)
    for k in (0, 1):
        low, high = (0, 0, k * UNIT[2]), (*UNIT[:2], (k + 1) * UNIT[2])
        addBlock(corners(low, high), unit, inPlane=inPlane)
    O.bodies[0].state.blockedDOFs = "xyzXYZ"
    if not zones:
        O.bodies[1].state.blockedDOFs = blocked
    units = MasonryZones(bodies=[1], damping=0) if zones else None
    engines([joint or MasonryJoint(elastic=True)], damping=0, gravity=gravity, zones=units)
    (made,) = connect()
    stiffness = made.phys.normalStiffness * UNIT[0] * UNIT[1]
    return math.sqrt(stiffness / O.bodies[1].state.mass)


def decrement(periods, count):
    """Logarithmic decrement of a vibration about zero along z, from its peaks in several periods of
    some steps each."""
    s = O.bodies[1].state
    away = lambda: s.pos[2] - s.refPos[2]
    peaks, before = [], [0.0, 0.0]
    for _ in range(periods * count):
        O.step()
        z = away()
        a, b = before
        if b > a and b >= z and b > 0:  # the top of the parabola through three places
            peaks.append(b - (z - a) ** 2 / (8 * (z - 2 * b + a)))
        before = [b, z]
    assert len(peaks) >= periods - 1
    return math.log(peaks[0] / peaks[-1]) / (len(peaks) - 1)


def damped(kind, ratio, inPlane=True):
    """Logarithmic decrement of a block on a joint: expected and measured [-]."""
    omega = oscillator(inPlane=inPlane)
    if kind == "mass":
        engine("integrator").massDamping = 2 * ratio * omega
    else:
        engine("joints").stiffnessDamping = 2 * ratio / omega
    O.dt = 2 * math.pi / omega / 4000
    O.bodies[1].state.vel = Vector3(0, 0, 0.1)
    return 2 * math.pi * ratio / math.sqrt(1 - ratio**2), decrement(4, 4000)


DECREMENT = "2π·ζ/√(1 − ζ²)"


@case(
    DAMPED,
    "logarithmic decrement, ζ = 0.05 by mass damping",
    DECREMENT,
    aim=0.005,
    quick=True,
)
def decrement_mass(quick):
    return damped("mass", 0.05)


@case(
    DAMPED,
    "logarithmic decrement, ζ = 0.05 by damping of joints",
    DECREMENT,
    aim=0.005,
    quick=True,
)
def decrement_stiffness(quick):
    return damped("stiffness", 0.05)


@case(DAMPED, "period of a brick on a joint [ms]", "2π·√(m/(kn·A))", aim=0.005, quick=True)
def period(quick):
    omega = oscillator(inPlane=True)
    O.dt = 2 * math.pi / omega / 400
    s = O.bodies[1].state
    s.vel = Vector3(0, 0, 0.1)
    crossings, last = [], 0.0
    while len(crossings) < 3:
        O.step()
        now = s.pos[2] - s.refPos[2]
        if last < 0 <= now or last > 0 >= now:
            crossings.append(O.time - O.dt * now / (now - last))
        last = now
    return 2e3 * math.pi / omega, 1e3 * (crossings[2] - crossings[0])


@case(
    DAMPED,
    "velocity of a falling block under mass damping of 5 1/s [m/s]",
    "g/c",
    aim=0.005,
    quick=True,
)
def terminal_velocity(quick):
    O.reset()
    body = addBlock(corners((0, 0, 0), UNIT), MasonryMat(density=1800))
    engines([MasonryJoint()], damping=0, gravity=(0, 0, -G))
    engine("integrator").massDamping = 5
    O.dt = 1e-3
    go(4)
    return G / 5, -O.bodies[body].state.vel[2]


def gravityWork(direction):
    """Work of a gravity that is raised step by step on two bricks on a joint: half of weight times
    way, and counted [J].

    :param way: ``"rigid"`` or ``"deformable"`` bricks, or ``"functors"``: YADE's own loop and
        integrator
    """
    O.reset()
    unit = MasonryMat(density=1800, young=4.8e9, poisson=0.16)
    for k in range(3):
        low, high = (0, 0, k * UNIT[2]), (*UNIT[:2], (k + 1) * UNIT[2])
        addBlock(corners(low, high), unit)
    fix(0)
    zones = None
    if direction == "deformable":
        zones = MasonryZones(bodies=[1, 2], damping=0.5)
    engines(
        [elastic(3e11)],
        damping=0.5,
        gravity=(0, 0, 0),
        zones=zones,
        functors=direction == "functors",
    )
    connect()
    O.dt = 0.5 * criticalTimeStep()[0]
    for n in range(8000):
        if n < 6000:
            engine("integrator").gravity = (0, 0, -G * (n + 1) / 6000)
        O.step()
    states = [O.bodies[k].state for k in (1, 2)]
    half = sum(0.5 * G * s.mass * (s.refPos[2] - s.pos[2]) for s in states)
    return half, engine("energy").balance()["gravity"]


@case(
    DAMPED,
    "work of gravity that grows, rigid bricks [J]",
    "½·m·g·u",
    aim=0.005,
    quick=True,
)
def gravity_work_rigid(quick):
    return gravityWork("rigid")


@case(DAMPED, "work of gravity that grows, deformable bricks [J]", "½·m·g·u", aim=0.005)
def gravity_work_deformable(quick):
    return gravityWork("deformable")
