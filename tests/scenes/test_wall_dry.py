# SPDX-License-Identifier: GPL-2.0-or-later
"""The dry-joint granite walls: their stiffness under load, their load line, and what they
refuse."""

from functools import partial

from hosted import *
from small_wall import Wall, settled

GRANITE = Wall(
    name="granite",
    length=1.0,
    courses=8,
    unit=(0.2, 0.2, 0.15),
    precompression=0.875e6,
    masonry=partial(materials.dryGranite, 175, 0.15),
)


def test_the_vertical_load_turns_the_wall_about_its_toe_and_keeps_its_line(runScene):
    curves = []
    for line in ("fixed", "riding"):
        _, out = runScene("wall_dry", "--load-line", line, "--rate", "40", "--no-vtk")
        assert readRun(out)["energy_balance_error"] < 1e-6
        curves.append(readCurve(out)["base_shear_kN"])
    fixed, riding = curves
    assert max(fixed) < (175 + 6.12) / (2 * 1.325)  # rigid rocking
    assert fixed[-1] > 0.98 * max(fixed)
    # 175 kN that move 30 mm towards the toe, over the height of the push
    assert fixed[-1] - riding[-1] == approx(175 * 0.030 / 1.325, rel=0.05)


@mark.parametrize("blocks, tolerance", [("rigid", 1e-3), ("deformable", 0.02)])
def test_joints_and_units_in_series_give_the_masonry(tmp_path, blocks, tolerance):
    # plane strain and the stiff platens make deformable units up to 1/(1 - 0.2²) stiffer, a fifth
    # of the whole Of one cell, the corners that lie on no diagonal of a face are held too loosely:
    # the wall is 2.3 % too soft.
    words = "--crack-surfaces off --blocks " + blocks
    words += " --divisions 2" * (blocks == "deformable")
    _, model, _ = settled(tmp_path, *words.split(), wall=GRANITE)
    loaded = model.loading.topDisplacement()[1]
    joint, young = model.joints["bed"].normalStiffness, 20.2e9
    assert 8 / joint + 1.2 / young == approx(1.2 / 4.068e9, rel=1e-9)
    own = 2600 * 9.81 * 1.2 / 2  # mean stress of the wall's weight [Pa]
    # Nine joints, two outer ones.
    expected = (0.875e6 + own) * (9 / joint + 1.2 / young)
    assert -loaded == approx(expected, rel=tolerance)
