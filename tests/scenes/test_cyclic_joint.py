# SPDX-License-Identifier: GPL-2.0-or-later
"""One joint in cycles, as validation/cyclic/joint.py drives it, against the closed forms of the
paper's law."""

from hosted import *


FOLDER = os.path.join(ROOT, "validation", "cyclic")
sys.path.insert(0, FOLDER)
import figures  # noqa: E402
from scipy.integrate import trapezoid  # noqa: E402

KS, FRICTION = 1.445e11, 0.43  # Pa/m


@pytest.fixture(scope="module")
def paths(tmp_path_factory):
    """Rows of every path under the paper's law, and the folder that they are in."""
    out = tmp_path_factory.mktemp("joint")
    words = ["--laws", "softening", "--rows", "60", "--steps", "20", "--out", str(out)]
    runProgram(os.path.join(FOLDER, "joint.py"), *words)
    names = ("tension", "closure", *figures.SHEAR)
    return {name: figures.read(out, "softening", name) for name in names}, out


def ways(values):
    """Rows at which a driven displacement turns, the first and the last row among them."""
    steps = np.sign(np.diff(values))
    return [0, *(1 + np.flatnonzero(steps[1:] * steps[:-1] < 0)), len(values) - 1]


@mark.parametrize("name", figures.SHEAR[1:])
def test_slip_cycles_take_the_work_of_friction(paths, name):
    """Where the bond is gone, a way from -a to +a takes 2 τr (a - τr/ks): within 3 %, as a bit of
    bond is left."""
    rows = paths[0][name]
    slide, shear = rows["slide_mm"], rows["shear_stress_MPa"]
    residual = FRICTION * float(name.split("_")[1])
    assert np.allclose(rows["normal_stress_MPa"], -residual / FRICTION, rtol=1e-3)
    turns = ways(slide)
    last = slice(turns[-3], turns[-2] + 1)
    assert slide[turns[-2]] == approx(-3, abs=0.01)
    assert slide[turns[-3]] == approx(3, abs=0.01)
    work = trapezoid(shear[last], slide[last])
    assert work == approx(2 * residual * (3 - 1e9 * residual / KS), rel=0.03)


def test_the_figure_shows_it(paths, tmp_path):
    figures.draw(paths[1], tmp_path / "joint.png")
    assert (tmp_path / "joint.png").stat().st_size > 20000
