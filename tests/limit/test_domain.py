# SPDX-License-Identifier: GPL-2.0-or-later
"""The N-V domain of a pier by limit analysis, against closed forms and against runs."""

from hosted import *
import masonry_capacity as capacity

WIDTH, THICK, COURSE, FRICTION, DENSITY = 0.6, 0.3, 0.2, 0.4, 2600.0
NORMALS = [5.0, 20.0, 80.0]  # [kN]


def pier(out, *words, stones=6, rotation="free", material=None, press=0.2e6, **platen):
    """A pier of stones on each other with a platen above, which a script pushes."""
    blocks = bricks.stack(stones, (WIDTH, THICK, COURSE))
    material = material or materials.dry(FRICTION, density=DENSITY)
    made = Scene("pier", blocks, material, arguments=["--out", str(out), "--no-vtk", *words])
    made.platen("bottom")
    top = made.platen("top", rotation=rotation, **platen)
    if press:
        made.press(top, press)
    return made, top


@mark.parametrize("stones", [1, 2, 3, 6, 9])
def test_a_dry_pier_tips_about_its_toe_or_slides(tmp_path, stones):
    """A cantilever pushed at its height h: N b/2 = V h about the toe, N with the weight; V = μ N in
    the joint below the platen, with the pressure alone."""
    made, top = pier(tmp_path / "r", "--preset", "bound", "--lean", stones=stones)
    made.settle()
    entries = made.domain(top, NORMALS)
    made.finish()
    weight = 1e-3 * DENSITY * 9.81 * WIDTH * THICK * COURSE * stones
    height = top.point[2]
    for pressed, entry in zip(NORMALS, entries):
        normal = pressed + weight
        assert entry["normal_kN"] == approx(normal, rel=1e-9)
        tips, slides = normal * WIDTH / (2 * height), FRICTION * pressed
        assert entry["factor"] == approx(min(tips, slides), rel=1e-5)
    found = capacity.domain(tmp_path / "r")
    assert [one.normal for one in found.bounds] == [e["normal_kN"] for e in entries]
    assert [one.largest for one in found.bounds] == [e["factor"] for e in entries]
    assert readRun(tmp_path / "r")["steps"] == 0


@mark.slow
def test_where_joints_crush_the_domain_is_concave_and_ends(tmp_path):
    """Bed joints of calcium-silicate masonry crush at some MPa: the shear force grows, and falls
    again, to nothing at the strength of the section."""
    made, top = pier(tmp_path / "r", "--preset", "bound", material=materials.calciumSilicate())
    made.settle()
    made.domain(top, [10, 200, 400, 800, 1200])
    made.finish()
    found = capacity.domain(tmp_path / "r")
    normal, shear = np.array([(one.normal, one.largest) for one in found.bounds]).T
    slopes = np.diff(shear) / np.diff(normal)
    assert slopes[0] > 0 > slopes[-1] and (np.diff(slopes) < 1e-9).all()
    assert not any(one.exact for one in found.bounds)


@mark.slow
def test_the_scene_stays_as_it_is(tmp_path):
    """The bound of a push is the same with a domain before it, and lies on the domain."""
    bounds = []
    for n, normals in enumerate(([], [30.0, 60.0])):
        made, top = pier(tmp_path / str(n), "--preset", "bound")
        made.settle()
        if normals:
            made.domain(top, normals)
        made.push(top, 1)
        made.finish()
        bounds.append(readRun(tmp_path / str(n))["bound_base_shear_kN"])
        O.reset()
    assert bounds[0] == bounds[1]
    weight = 1e-3 * DENSITY * 9.81 * WIDTH * THICK * COURSE * 6
    own = 1e-3 * 0.2e6 * WIDTH * THICK + weight
    assert capacity.domain(tmp_path / "1").shear(own) == approx(bounds[0], rel=1e-5)


@mark.slow
def test_a_run_is_a_point_below_its_bound(tmp_path):
    """A slow push of a dry pier with stiff joints reaches what rigid blocks carry, but for what it
    leans."""
    stiff = materials.dry(FRICTION, normalStiffness=1e11, density=DENSITY)
    made, top = pier(tmp_path / "r", "--rate", "5", material=stiff)
    made.settle()
    made.domain(top, [20.0, 60.0])
    made.push(top, 1.0)
    made.finish()
    found = capacity.domain(tmp_path / "r", [tmp_path / "r"])
    (point,) = found.runs
    most = found.shear(point.normal)
    assert point.source == "curve.csv: base_force_z_kN"
    assert 0.97 * most < point.shear < 1.005 * most
    # what the bilinear curve takes from a run is there
    assert readRun(tmp_path / "r")["recorded_height_m"] == approx(top.recorded[2])
    curve = capacity.bilinearOf(tmp_path / "r")
    assert curve.yieldForce < curve.peakForce == approx(point.shear)


@mark.slow
def test_a_domain_is_kept_when_a_run_is_resumed(tmp_path):
    kept = []
    for words in ([], ["--until", "0.1", "--resume", str(tmp_path)]):
        made, top = pier(tmp_path, *words)
        made.settle()
        entries = made.domain(top, NORMALS)
        made.push(top, 0.05)
        made.finish()
        kept.append((entries, capacity.domain(tmp_path).bounds))
        O.reset()
    assert kept[0] == kept[1] and len(kept[0][1]) == len(NORMALS)


def test_what_has_no_domain_is_refused(tmp_path):
    made, top = pier(tmp_path / "r", press=None)
    made.settle()
    with raises(ValueError, match=r"domain: top is not pressed: press\(top, ...\)"):
        made.domain(top, NORMALS)
    O.reset()
    made, top = pier(tmp_path / "q", drive="z")
    made.settle()
    with raises(ValueError, match="domain: top is held along z"):
        made.domain(top, NORMALS)

    with raises(Refused, match="direction .* must be a horizontal direction"):
        made.domain(top, NORMALS, direction=(1, 0, 1))
