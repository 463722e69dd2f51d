# SPDX-License-Identifier: GPL-2.0-or-later
"""Stages against Newton's laws: a few cells of validation/statics, other ones in every run of the
tests."""

from hosted import *
import statics

SEED = int(os.environ.get("STATICS_SEED", time.time() // 86400))  # other ones every day


def sample(stage, count):
    """Cells of a stage that are drawn by the seed."""
    cells = [cell for cell in statics.cells() if cell[0] == stage]
    return random.Random(f"{SEED} {stage}").sample(cells, count)


@mark.parametrize("stage", statics.STAGES)
def test_a_stage_obeys_newton_or_says_why_it_is_refused(stage):
    for cell in sample(stage, 1):
        try:
            refusal = statics.carryOut(cell)
        except statics.Wrong as wrong:
            pytest.fail(f"STATICS_SEED={SEED}: {', '.join(cell)}: {wrong}")
        if refusal is not None:
            assert len(refusal.splitlines()) == 1 and len(refusal) > 20, refusal


def test_every_stage_has_a_cell_that_is_allowed():
    for stage in statics.STAGES:
        kind = {"drive": "driven", "release": "driven", "hold": "handle"}.get(stage, "free")
        cell = stage, kind, "x", "rigid", "softening"
        assert statics.carryOut(cell) is None, cell


@mark.parametrize(
    "spoil, message",
    [
        (lambda s: s.model.loading.loads.pop("top_press"), "from outside"),
        (lambda s: s.model.supports.held.pop(0), "from outside"),
        (lambda s: s.columns.pop(_base(s)), "has no column|sum up"),
    ],
)
def test_the_oracle_sees_a_fault(monkeypatch, spoil, message):
    act = statics.act

    def spoiled(made, cell, target, base):
        ended = act(made, cell, target, base)
        spoil(made)
        return ended

    monkeypatch.setattr(statics, "act", spoiled)
    with raises(statics.Wrong, match=message):
        statics.carryOut(("run", "free", "x", "rigid", "softening"))


def _base(scene):
    return [c.head for c in scene.columns].index("base_force_z_kN")
