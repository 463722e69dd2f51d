# SPDX-License-Identifier: GPL-2.0-or-later
"""Motion of blocks that meet: rest, slopes, dominoes, a rocking block, a heap."""

import math

import numpy as np
from contact_rows import Row, case
from contact_scenes import BRICK, G, balance, box, ground, lean, prepare, until
from yade import O, Quaternion, Vector3

# -- rest and slopes -------------------------------------------------------------------------------


@case
def rest(quick):
    """A brick that falls on the ground and lies there for a minute."""
    end = 3 if quick else 60
    base = ground()
    brick = box(BRICK, (0.3, 0.1, 0.05 + BRICK[2] / 2))
    contacts = prepare(0.9)
    s = O.bodies[brick].state
    start, worst = s.pos[2], 0.0
    while O.time < 0.1 - O.dt:
        O.step()
        # the sum of the steps of the leapfrog scheme, whose velocity begins half a step late
        fallen = G * O.dt**2 * O.iter * (O.iter + 1) / 2
        worst = max(worst, abs(s.pos[2] - start + fallen))
    until(2)
    there = Vector3(s.pos)
    until(end)
    weight = s.mass * G
    return [
        Row("path of the fall, largest error [m]", "½·g·t·(t + Δt)", worst, limit=1e-9),
        Row("force on the ground [N]", "weight", contacts.forceOf(base, brick)[2], weight, 1e-6),
        Row(
            f"what the brick moves from 2 s to {end} s [m]", "0", (s.pos - there).norm(), limit=1e-6
        ),
        Row(
            "depth [m]",
            "weight over stiffness times area, without the rim",
            BRICK[2] / 2 - s.pos[2],
            weight / (1e10 * BRICK[0] * BRICK[1]),
        ),
    ]


@case
def slope(quick):
    """A brick on a slope of 20, 30 and 40°, friction 0.5."""
    end = 3 if quick else 60
    rows = []
    for degrees in (20, 30, 40):
        O.reset()
        angle = math.radians(degrees)
        turn = Quaternion(Vector3(0, 1, 0), angle)
        ground(turn, (8, 2, 0.4))
        depth = 1800 * BRICK[2] * G * math.cos(angle) / 1e10
        s = O.bodies[box(BRICK, turn * Vector3(-3, 0, BRICK[2] / 2 - depth), turn)].state
        prepare(0.9)
        if math.tan(angle) < 0.5:
            until(0.5)
            there = Vector3(s.pos)
            until(end)
            rows.append(
                Row(
                    f"creep at {degrees}° from 0.5 s to {end} s [m]",
                    "0: tan 20° is below 0.5",
                    (s.pos - there).norm(),
                    limit=1e-6,
                )
            )
            continue
        down = turn * Vector3(1, 0, 0)
        until(0.05)
        first, then = s.vel.dot(down), O.time
        until(0.6)
        found = (s.vel.dot(down) - first) / (O.time - then)
        expected = G * (math.sin(angle) - 0.5 * math.cos(angle))
        rows.append(
            Row(f"acceleration at {degrees}° [m/s²]", "g·(sin − μ·cos)", found, expected, 1e-3)
        )
    return rows


# -- dominoes --------------------------------------------------------------------------------------

THICK, WIDE, TALL = 0.0075, 0.024, 0.048  # of a domino [m]


def toppling(gap, friction, count=20, restitution=0.3, stiffness=1e9):
    """Times at which the dominoes of a row have turned by half of what brings each to the next [s];
    the first is pushed.

    Restitution 0.3: the impacts of the theory are plastic, and softer impacts differ little.
    """
    O.reset()
    pitch = THICK + gap
    ground(size=((count + 4) * pitch + 4 * TALL, 6 * WIDE, TALL))
    first = -0.5 * count * pitch
    row = [box((THICK, WIDE, TALL), (first + n * pitch, 0, TALL / 2)) for n in range(count)]
    prepare(0.5, friction=friction, restitution=restitution, normalStiffness=stiffness)
    s, spin = O.bodies[row[0]].state, 6.0
    s.angVel, s.vel = Vector3(0, spin, 0), 0.5 * spin * Vector3(TALL, 0, -THICK)
    aim, times, before = 0.5 * math.asin(gap / TALL), [], 0.0
    while len(times) < count:
        if O.time > 3:
            raise RuntimeError(f"domino {len(times)} still stands after 3 s")
        O.step()
        now = lean(row[len(times)])
        if now < aim:
            before = now
        else:
            times.append(O.time - O.dt * (now - aim) / (now - before))
            before = 0.0
    return np.array(times)


def theory(gap, friction, count=20, spin=6.0):
    """Speeds of the wave between the dominoes of a row [m/s] by the theory of Shaw (1978) and van
    Leeuwen (2010): dominoes turn about their feet, which do not slip, those behind the front lean
    on each other, and an impact is plastic.

    The angles of those behind follow from that of the front. Friction acts where a top edge slides
    down the domino before it. The equations of motion, of which factors let the forces between
    dominoes vanish, are integrated over the time between two impacts; the factors carry the impact
    over, too.
    """
    pitch = THICK + gap
    inertia = (TALL**2 + THICK**2) / 3  # over the mass, about the foot
    contact = math.asin(gap / TALL)

    def chain(front, number):
        """Angles of the front and those behind, derivatives by that of the front, and factors."""
        angles, rates, factors = [front], [1.0], [1.0]
        for _ in range(number - 1):
            a = angles[-1]
            b = a + math.asin(min(1.0, (pitch * math.cos(a) - THICK) / TALL))
            along = TALL * math.cos(b - a)
            lever = along - pitch * math.sin(a)
            angles.append(b)
            rates.append(rates[-1] * lever / along)
            back = along + friction * TALL * math.sin(b - a)
            factors.append(factors[-1] * (lever - friction * THICK) / back)
        return map(np.array, (angles, rates, factors))

    def moment(angles):
        return 0.5 * G * (TALL * np.sin(angles) - THICK * np.cos(angles))

    def acceleration(front, speed, number):
        step = 1e-6
        angles, rates, factors = chain(front, number)
        _, more, _ = chain(front + step, number)
        _, less, _ = chain(front - step, number)
        pull = factors @ moment(angles) - inertia * speed**2 * (factors @ (more - less)) / (
            2 * step
        )
        return pull / (inertia * (factors @ rates))

    speed, speeds = spin, []
    for number in range(1, count):
        front, took, step = 0.0, 0.0, contact / 200 / max(speed, 1.0)
        while True:  # midpoint rule
            half = speed + 0.5 * step * acceleration(front, speed, number)
            place = front + 0.5 * step * speed
            if front + step * half >= contact:
                took += (contact - front) / half
                break
            speed += step * acceleration(place, half, number)
            front, took = front + step * half, took + step
        _, rates, factors = chain(contact, number)
        # impact: the next domino stands upright, where its factors are those of an angle of zero
        _, ahead, weights = chain(0.0, number + 1)
        speed *= (weights[1:] @ rates) / (weights @ ahead)
        speeds.append(pitch / took)
    return np.array(speeds), speed


@case
def dominoes(quick):
    """The wave in a row of 20 dominoes of 7.5 × 24 × 48 mm."""
    scale = math.sqrt(G * TALL)
    rows = []
    for gap in (0.02,) if quick else (0.01, 0.02, 0.03):
        speeds = (THICK + gap) / np.diff(toppling(gap, 0.3)) / scale
        ideal = theory(gap, 0.3)[0] / scale
        uneven = lambda all: abs(all[5:] / all[5:].mean() - 1).max()
        of = f"gap {1e3 * gap:g} mm"
        dense = (
            "a dense row needs more than five dominoes: by the theory the difference is"
            f" {uneven(ideal):.3f}"
        )
        rows += [
            Row(
                f"speed after the fifth, largest difference from the mean, {of} [-]",
                "0: a wave of constant speed",
                uneven(speeds),
                limit=0.05,
                misses=dense if uneven(ideal) > 0.1 else "",
            ),
            Row(
                f"speed of the wave over √(g h), {of} [-]",
                "theory with plastic impacts, no slip at the feet, the same friction",
                speeds[-1],
                ideal[-1],
            ),
            Row(f"the same, {of} [-]", "usual speeds of rows of dominoes", speeds[-1], (1, 2)),
        ]
    return rows


# -- rocking ---------------------------------------------------------------------------------------

SLENDER, SQUAT = (0.1, 0.3, 1.0), (0.25, 0.3, 1.0)  # rocking blocks [m]


def rocking(restitution, share, impacts, size=SLENDER, stiffness=1e12, step=0.5):
    """A block on the ground that is let go at a share of its slenderness angle.

    :returns: shares of that angle at which it stands still, and the times at which it is upright
        [s]
    """
    O.reset()
    ground(size=(2, 1, 0.4))
    width, _, height = size
    alpha = math.atan(width / height)
    turn, edge = Quaternion(Vector3(0, 1, 0), share * alpha), Vector3(width / 2, 0, 0)
    body = box(size, edge + turn * (Vector3(0, 0, height / 2) - edge), turn)
    prepare(step, friction=2, restitution=restitution, normalStiffness=stiffness)
    angle = lambda: share * alpha + lean(body)
    shares, times, farthest, before = [share], [], 0.0, share * alpha
    while len(times) < impacts:
        if O.time > 20:
            raise RuntimeError(f"{len(times)} impacts in 20 s")
        O.step()
        now = angle()
        if now * before < 0:
            if times:
                shares.append(farthest / alpha)
            times.append(O.time - O.dt * now / (now - before))
            farthest = 0.0
        farthest = max(farthest, abs(now))
        before = now
    return shares, times


def pace(size):
    """p of Housner [1/s]: the root of 3 g / 4 R."""
    return math.sqrt(0.75 * G / (0.5 * math.hypot(size[0], size[2])))


@case
def rocking_period(quick):
    """Time from rest to rest of a slender block by its amplitude."""
    rows, p = [], pace(SLENDER)
    for share in (0.5,) if quick else (0.25, 0.5, 0.75):
        quarter = rocking(1, share, 1)[1][0]
        rows.append(
            Row(
                f"quarter period, θ0/α = {share} [s]",
                "Housner 1963: acosh(1/(1 − θ0/α))/p",
                quarter,
                math.acosh(1 / (1 - share)) / p,
                0.01,
            )
        )
    if quick:
        return rows
    shares, times = rocking(0.3, 0.6, 5)
    for n in range(1, len(times)):
        half = 2 * math.acosh(1 / (1 - shares[n])) / p
        rows.append(
            Row(
                f"half period after impact {n}, restitution 0.3, where θ/α = {shares[n]:.3f} [s]",
                "Housner 1963: 2·acosh(1/(1 − θ/α))/p",
                times[n] - times[n - 1],
                half,
                0.01,
            )
        )
    return rows


@case
def rocking_loss(quick):
    """What of the energy remains after an impact."""
    rows = []
    blocks = ((SLENDER, (0.1, 0.2, 0.3, 0.5, 0.7, 1)), (SQUAT, (0.1, 0.5, 1)))
    for size, values in blocks[1:] if quick else blocks:
        alpha = math.atan(size[0] / size[2])
        rigid = (1 - 1.5 * math.sin(alpha) ** 2) ** 2
        energy = lambda share: math.cos(alpha * (1 - share)) - math.cos(alpha)
        for restitution in values[:1] if quick else values:
            shares, _ = rocking(restitution, 0.5, 2, size, 1e11 if quick else 1e12)
            kept = energy(shares[1]) / energy(shares[0])
            rows.append(
                Row(
                    (
                        f"energy after the first impact over that before, α = {alpha:.4f},"
                        f" restitution {restitution} [-]"
                    ),
                    "Housner 1963: (1 − 1.5·sin²α)²",
                    kept,
                    rigid,
                )
            )
    return rows


# -- heap ------------------------------------------------------------------------------------------


def heap(count, seed=3, abreast=10, size=(0.11, 0.102, 0.081), density=1800.0):
    """Half bricks above each other, so many abreast, turned at random, over a ground; returns their
    ids."""
    scale = size[0] / 0.11
    ground(size=(20 * scale, 20 * scale, 0.4 * scale))
    dice = np.random.default_rng(seed)
    bodies = []
    for n in range(count):
        turn = Quaternion(*dice.normal(size=4))
        turn.normalize()
        x, y = 0.15 * dice.uniform(-1, 1, 2)
        level, column = divmod(n, abreast)
        place = scale * np.array([x + 0.5 * column, y, 0.1 + 0.16 * level])
        bodies.append(box(size, place, turn, density=density))
    return bodies


@case
def heaps(quick):
    """Half bricks that are dropped, each turned at random."""
    count, abreast, end = (12, 1, 2.1) if quick else (200, 10, 3.0)
    bodies = heap(count, abreast=abreast)
    prepare(0.2, normalStiffness=1e9, restitution=0.3)
    until(end)
    found = balance()
    return [
        Row(
            (
                f"{count} half bricks: error of the energy balance after {end} s, over the work"
                " done [-]"
            ),
            "0",
            abs(found["error"]),
            limit=1e-3,
        ),
        Row(
            "kinetic energy at the end over the work of gravity [-]",
            "0: at rest",
            found["kinetic"] / found["gravity"],
            limit=1e-5,
        ),
        Row(
            "lowest middle of a block above the ground over half of its least size [-]",
            "1 or more: none has sunk in",
            min(O.bodies[b].state.pos[2] for b in bodies) / (0.081 / 2),
            (0.99, 100),
        ),
    ]
