# SPDX-License-Identifier: GPL-2.0-or-later
"""Problems of compas_dem through scripts/compas.py: forces of contacts against statics, what its
results must have, and what is refused before the run."""

import runpy

from hosted import *
from barrel_vault import *
from masonry.bricks import stack
from masonry.scene.compas_problems import readProblem

main = runpy.run_path(os.path.join(ROOT, "scripts", "compas.py"))["main"]
WEIGHT = DENSITY * GRAVITY * 0.5 * 0.4 * 0.3  # of a block [N]
STACK = stack(2, (0.5, 0.4, 0.3)).moved(-0.25, -0.2)


@pytest.fixture
def solve(tmp_path, monkeypatch):
    """Runs a problem; returns the graph of its results."""
    monkeypatch.chdir(tmp_path)

    def solve(asked):
        (tmp_path / "problem.json").write_text(json.dumps(asked))
        main(["problem.json", "results.json", "--lean"])
        with open("results.json") as file:
            return json.load(file)["data"]["model"]["data"]["graph"]

    return solve


def middleOf(edge):
    """Where the force of a contact acts: the mean of its points by their normal forces."""
    return np.average(edge["contact_point"], axis=0, weights=edge["force_normal"])


TOP = [[-0.25, -0.2, 0.6], [0.25, -0.2, 0.6], [0.25, 0.2, 0.6], [-0.25, 0.2, 0.6]]
POLYGON = typed("compas.geometry/Polygon", points=TOP)
PUSH = dict(block_index=1, force=[0, 0, -1000.0], moment=None, loading_type="ramp")
#: Conditions of two blocks, force on the lower one [N], and where it acts [m].
CASES = {
    "weight": ({}, (0, 0, -WEIGHT), (0, 0)),
    "no gravity": (dict(gravity=False), (0, 0, -WEIGHT), (0, 0)),
    "upwards": (dict(body_forces=[[0, 0, GRAVITY / 2]]), (0, 0, -WEIGHT / 2), (0, 0)),
    "sideways": (
        dict(body_forces=[[0, 1.0, 0], [0, 0.5, 0]]),
        (0, 1.5 / GRAVITY * WEIGHT, -WEIGHT),
        (0, 1.5 / GRAVITY * 0.15),
    ),
    "point load": (
        dict(point_loads=[{**PUSH, "point": [0.1, 0, 0.6]}]),
        (0, 0, -WEIGHT - 1000),
        (100 / (WEIGHT + 1000), 0),
    ),
    "load on the support": (
        dict(point_loads=[{**PUSH, "block_index": 0}]),
        (0, 0, -WEIGHT),
        (0, 0),
    ),
    "point load at the middle": (dict(point_loads=[PUSH]), (0, 0, -WEIGHT - 1000), (0, 0)),
    "surface load": (
        dict(surface_loads=[dict(block_index=1, polygon=POLYGON, magnitude=-5e3)]),
        (0, 0, -WEIGHT - 1e3),
        (0, 0),
    ),
}


@mark.parametrize("name", CASES)
def test_the_contact_of_two_blocks_is_that_of_statics(solve, name):
    conditions, force, place = CASES[name]
    graph = solve(problem(STACK, [0], conditions=conditions))
    [(u, v, edge)] = edges(graph)
    assert (u, v) == (0, 1)
    assert edge["force"] == approx(force, abs=2e-3 * WEIGHT)
    assert middleOf(edge)[:2] == approx(place, abs=1e-3)


def test_an_edge_has_what_compas_dem_reads(solve):
    """The edge keeps its sense in the graph, and what it had but forces of an earlier run."""
    asked = problem(STACK, [0], conditions=dict(body_forces=[[2, 1, 0]]))
    graph = asked["data"]["model"]["data"]["graph"]
    graph["edge"] = {"1": {"0": dict(contacts=["kept"])}, "0": {"0": dict(force=[1, 2, 3])}}
    graph = solve(asked)
    edge = graph["edge"]["1"]["0"]
    assert edge["contacts"] == ["kept"] and graph["edge"]["0"] == {"0": {}}
    frame, total = edge["contact_frame"]["data"], np.array(edge["force"])
    along, normal = np.array(frame["xaxis"]), np.array(frame["yaxis"])
    assert normal == approx([0, 0, -1], abs=1e-6)  # towards block 0
    parts = [sum(edge[f"force_{part}"]) for part in ("normal", "tangent1", "tangent2")]
    assert parts @ np.array([normal, along, np.cross(along, normal)]) == approx(total)
    contact = edge["contact_data"]["data"]
    axes = [np.array(contact["frame"]["data"][axis]) for axis in ("xaxis", "yaxis")]
    pushes = [
        one["c_u"] * axes[0] + one["c_v"] * axes[1] + (one["c_np"] - one["c_nn"]) * np.cross(*axes)
        for one in contact["forces"]
    ]
    assert sum(pushes) == approx(total) and np.array(pushes) == approx(
        np.array(edge["force_vector"])
    )
    corners = np.array(edge["contact_polygon"]["data"]["points"])
    assert np.cross(corners[1] - corners[0], corners[2] - corners[1]) @ normal == approx(0.2)
    assert set(edge["status"]) == {"stic"} and max(np.abs(edge["gap"])) < 1e-6
    assert edge["face_contact"] and not edge["edge_contact"] and not edge["point_contact"]


def test_each_block_has_the_density_of_its_material(solve):
    asked = problem(STACK, [0])
    model = asked["data"]["model"]["data"]
    model["materials"]["light"] = typed("compas_dem.material/Stone", density=DENSITY / 4)
    model["elements"]["block 1"]["data"]["material"] = "light"
    [(_, _, edge)] = edges(solve(asked))
    assert edge["force"] == approx([0, 0, -WEIGHT / 4], abs=1e-3 * WEIGHT)


@mark.parametrize(
    "contact, friction, normal, shear",
    [
        (dict(mu=0.7), 0.7, 1e12, 4e11),
        (dict(phi=45, mu=0.1), 1, 1e12, 4e11),  # compas_dem takes phi, too
        (dict(mu=0.5, k_n=1e10), 0.5, 1e10, 4e9),
        (dict(mu=0.5, k_n=1e10, k_t=1e9), 0.5, 1e10, 1e9),
    ],
)
def test_joints_are_those_of_the_contact_model(tmp_path, contact, friction, normal, shear):
    (tmp_path / "a.json").write_text(json.dumps(problem(STACK, [0], **contact)))
    bed = readProblem(tmp_path / "a.json", "results.json").masonry.joints["bed"]
    found = bed.friction, bed.residualFriction, bed.normalStiffness, bed.shearStiffness
    assert found == approx((friction, friction, normal, shear))


def test_a_support_that_moves_takes_the_block_on_it_along(solve):
    graph = solve(problem(STACK, [0], [(0, (0.004, 0.002, 0.001))]))
    for node in graph["node"].values():
        matrix = np.array(node["transformation"]["data"]["matrix"])
        assert matrix[:3, 3] == approx([0.004, 0.002, 0.001], abs=2e-6)
        assert matrix[:3, :3] == approx(np.eye(3), abs=1e-6)


def test_bond_carries_a_block_that_hangs(solve):
    graph = solve(problem(STACK, [1], t_c=2e5, c=3e5))
    [(_, _, edge)] = edges(graph)
    assert edge["force"] == approx([0, 0, WEIGHT], abs=2e-3 * WEIGHT)
    assert all(one["c_np"] == 0 < one["c_nn"] for one in edge["contact_data"]["data"]["forces"])


def test_what_falls_has_no_results(solve, capsys):
    with raises(SystemExit):
        solve(problem(STACK, [1]))
    assert "results.json is not written" in capsys.readouterr().out
    assert not os.path.exists("results.json")


def test_a_vault_on_spreading_supports_is_that_of_compas_dem(solve):
    blocks, held = vault()
    spread = [(n, (SPREAD, 0, 0)) for n in held if blocks[n].middle[0] > 0]
    graph = solve(problem(blocks, held, spread))
    found = measured(blocks, held, graph)
    assert found[:3] == approx(PUBLISHED[:3], rel=SHARE)
    assert found[3:] == approx(PUBLISHED[3:], abs=NEAR)


def spoiled(*keys, **values):
    """The problem of two blocks with other values somewhere."""
    asked = json.loads(json.dumps(problem(STACK, [0])))
    place = asked["data"]
    for key in keys:
        place = place[key]["data"] if "data" in place[key] else place[key]
    place.update(values)
    return asked


def asking(**conditions):
    return problem(STACK, [0], conditions=conditions)


JOINT = typed("compas_dem.interactions/JointModel", kn=1e9, kt=1e9)
REFUSED = {
    "no problem": (problem(STACK, [0])["data"]["model"], "no boundary_conditions"),
    "no support": (problem(STACK, []), "no block is held"),
    "moment": (asking(point_loads=[{**PUSH, "moment": [0, 1, 0]}]), "moment on block 1"),
    "sudden": (asking(point_loads=[{**PUSH, "loading_type": "instantaneous"}]), "is no ramp"),
    "lifted": (asking(body_forces=[[0, 0, 20]]), "body_forces lift the blocks by 10.19"),
    "unknown block": (asking(point_loads=[{**PUSH, "block_index": 7}]), "block_index 7"),
    "turned": (
        asking(displacements=[dict(block_index=0, translation=None, rotation=[0, 0.1, 0])]),
        "rotation of block 0",
    ),
    "far": (
        asking(displacements=[dict(block_index=0, translation=[math.nan, 0, 0], rotation=None)]),
        "displacements: nan must be None or a number",
    ),
    "no area": (
        asking(
            surface_loads=[
                dict(block_index=1, polygon=typed("x/Polygon", points=TOP[:2]), magnitude=1)
            ]
        ),
        "polygon without an area",
    ),
    "others": (asking(temperatures=[20]), "temperatures is not known"),
    "words": (asking(point_loads=[{**PUSH, "force": ["a", 0, 0]}]), "force [N] ['a', 0, 0] must"),
    "infinite": (asking(body_forces=[[0, 0, math.inf]]), "body_forces [0, 0, inf] must be finite"),
    "joint_model": (spoiled("contact_properties", joint_model=JOINT), "joint_model: kn and kt"),
    "law": (
        spoiled("contact_properties", contact_model=typed("x/Tresca", c=1)),
        "contact_model Tresca: must be MohrCoulomb",
    ),
    "no friction": (spoiled("contact_properties", "contact_model", mu=None), "neither phi nor mu"),
    "no graph": (spoiled("model", graph={}), "an element has no node in the graph"),
    "no density": (spoiled("model", materials={}), "its material has no density"),
}


@mark.parametrize("name", REFUSED)
def test_what_cannot_be_said_is_refused_before_the_run(solve, name, capsys):
    asked, said = REFUSED[name]
    with raises(SystemExit) as ended:
        solve(asked)
    assert ended.value.code == 2 and said in capsys.readouterr().err
    assert not os.path.exists("results") and not os.path.exists("results.json")


@settings(max_examples=100, deadline=None)
@given(some.data())
def test_a_damaged_problem_is_read_or_refused(tmp_path_factory, data):
    """A value anywhere in what a problem asks for is another one."""
    asked = asking(point_loads=[PUSH], body_forces=[[0, 0, 1]], displacements=[dict(block_index=0)])
    value = json.loads(json.dumps(asked))
    holder = value["data"]
    key = data.draw(some.sampled_from(["boundary_conditions", "contact_properties"]))
    for _ in range(data.draw(some.integers(0, 6))):
        inner = holder[key]
        if not isinstance(inner, (dict, list)) or not inner:
            break
        holder = inner
        keys = [*inner] if isinstance(inner, dict) else range(len(inner))
        key = data.draw(some.sampled_from(keys))
    wrong = some.none() | some.booleans() | some.floats() | some.text() | some.just([])
    holder[key] = data.draw(wrong | some.just({}))
    path = tmp_path_factory.mktemp("damaged") / "problem.json"
    path.write_text(json.dumps(value))
    try:
        readProblem(path, "results.json")
    except ValueError as error:
        assert str(error).isprintable()


def test_the_program_ends_with_a_status(tmp_path):
    write = lambda asked: (tmp_path / "problem.json").write_text(json.dumps(asked))
    words = "compas", "problem.json", "results.json", "--lean"
    write(problem(STACK, []))
    done = runProgram(*words, check=False, cwd=tmp_path)
    assert done.returncode == 2 and "no block is held" in done.stderr
    write(problem(STACK, [0]))
    assert "at rest" in runProgram(*words, cwd=tmp_path).stdout
