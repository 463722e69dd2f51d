# SPDX-License-Identifier: GPL-2.0-or-later
"""A further kind of connector is its class of records and a command: columns, run.json, ``--set``,
energies and sections know it without a line of their own. Here it is a rope over a pulley with a
weight at its end, whose force hardly changes."""

from dataclasses import dataclass

from hosted import *
from masonry.scene.ties import End, Tie
from masonry.scene.script import describes
from yade.wrapper import MasonryTies


@dataclass
class Rope(Tie):
    WORD, PLURAL = "rope", "ropes"

    @staticmethod
    def engineOf(records, **ends):
        never = [1e300] * len(records)
        softly = dict(stiffness=[one.stiffness for one in records], compression=[0] * len(records))
        rests = [one.rest(0) for one in records]
        return MasonryTies(
            label="ropes", strength=never, breaking=never, rest=rests, **softly, **ends
        )


@describes
def rope(description, brick, anchor, weight):
    ends = End(description.middle(brick), brick=brick), End(anchor)
    made = Rope(f"rope{brick}", ends, 0.01 * weight, None, weight, 0.0, None, False)
    description.connectors.append(made)
    return made


def test_a_rope_pulls_with_its_weight_and_is_known_everywhere(tmp_path):
    stone = materials.dry(friction=0.7, normalStiffness=2e10, density=2000)
    blocks, word = bricks.stack(2, (0.4, 0.4, 0.3)), "--set=rope1.prestress=300"
    scene = standing(tmp_path, blocks, stone, word)
    tie = scene.tie(0, anchor=(-1, 0.2, 0.15), stiffness=1e5)
    made = rope(scene, 1, (2.0, 0.2, 0.45), 200.0)
    scene.section(0.3)
    scene.settle()
    scene.finish()
    run, curve = readRun(tmp_path), readCurve(tmp_path)
    assert curve["rope1_force_kN"][-1] == approx(0.3, rel=1e-4)
    assert run["ropes"][0]["prestress_N"] == 300 and run["ties"][0]["name"] == tie.name
    shear = next(n for n in curve if n.startswith("section") and "_V_x" in n)
    # the rope to the ground crosses the section, and so does what it pulls through the joint
    assert abs(curve[shear][-1]) < 1e-3
    both = curve["base_force_x_kN"][-1] + curve["tie0_force_kN"][-1]
    assert abs(both) == approx(0.3, rel=0.02)
    assert abs(curve["balance_error"][-1]) < 1e-8
    assert made.state == "elastic"
