# SPDX-License-Identifier: GPL-2.0-or-later
"""Stones in files of COMPAS: where they stand, and what is refused."""

from usual import *
from masonry.bricks import fromFile, readCompas

CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def typed(kind, **data):
    return {"dtype": kind, "data": data}


def mesh(dz=0.0, faces=SIDES, kind="compas.datastructures/Mesh", **more):
    """A cube from 0 to 1 m, raised."""
    vertex = {str(n): dict(x=x, y=y, z=z + dz) for n, (x, y, z) in enumerate(CORNERS)}
    return typed(kind, vertex=vertex, face={str(n): [*f] for n, f in enumerate(faces)}, **more)


def moved(dx=0.0, dz=0.0, turn=((1, 0, 0), (0, 1, 0), (0, 0, 1))):
    rows = [[*row, d] for row, d in zip(turn, (dx, 0, dz))]
    return typed("compas.geometry/Transformation", matrix=[*rows, [0, 0, 0, 1]])


def element(transformation=None, geometry=None, kind="compas_dem.elements/Block", **more):
    data = dict(transformation=transformation, features=[], name="stone", **more)
    return typed(kind, geometry=geometry or mesh(), **data)


GROUP = typed("compas_model.elements/Group", transformation=moved(dz=10), name="pier")


def model(*elements, tree=(), whole=None, **more):
    """A model whose elements are named by their numbers."""
    root = dict(root=dict(name="root", children=list(tree)))
    data = dict(transformation=whole, elements={str(n): e for n, e in enumerate(elements)})
    return typed("compas_dem.models/BlockModel", **data, tree=root, **more)


def assembly(*meshes, interface=None, kind="compas_assembly.datastructures/Assembly"):
    node = {str(n): dict(block=one, is_support=n == 0) for n, one in enumerate(meshes)}
    edge = {"0": {"1": dict(interfaces=[typed("x/Interface", mesh=interface)])}}
    graph = typed("compas.datastructures/Graph", node=node, edge=edge)
    return typed(kind, attributes=dict(name="Assembly"), graph=graph)


def box(frame, **sides):
    return typed("compas.geometry/Box", frame=frame, **sides)


FRAME = dict(point=[2, 0, 0], xaxis=[0, 1, 0], yaxis=[-1, 0, 0])
QUARTER = (0, -1, 0), (1, 0, 0), (0, 0, 1)  # turns x to y
POLYHEDRON = dict(vertices=[[x, y, 2 * z] for x, y, z in CORNERS], faces=[[*f] for f in SIDES])
FLAT = mesh(faces=SIDES[:1])
TREE = [dict(element="0", children=[dict(element="1")]), dict(element="2")]
CUBE = (0, 0, 0), (1, 1, 1)
#: A value, and the lowest and highest corner of each block in it.
READ = {
    "mesh": (mesh(), [CUBE]),
    "meshes": ([[mesh()], {"more": mesh(2), "size": 3}], [CUBE, ((0, 0, 2), (1, 1, 3))]),
    "elements are placed": (
        model(element(), element(moved(1, 0.5))),
        [CUBE, ((1, 0, 0.5), (2, 1, 1.5))],
    ),
    "element, then group, then model": (
        model(GROUP, element(moved(2)), element(), tree=TREE, whole=moved(0, 1, QUARTER)),
        [((-1, 2, 11), (0, 3, 12)), ((-1, 0, 1), (0, 1, 2))],
    ),
    "mirrored": (
        model(element(moved(turn=((-1, 0, 0), (0, 1, 0), (0, 0, 1))))),
        [((-1, 0, 0), (0, 1, 1))],
    ),
    "millimetres": (
        model(element(moved(turn=((1e-3, 0, 0), (0, 1e-3, 0), (0, 0, 1e-3))))),
        [((0, 0, 0), (1e-3, 1e-3, 1e-3))],
    ),
    "interfaces are no stones": (
        assembly(mesh(), mesh(1), interface=FLAT),
        [CUBE, ((0, 0, 1), (1, 1, 2))],
    ),
    "contacts are no stones": (
        model(element(), graph=dict(edge={"0": {"1": dict(contacts=[FLAT], modifiers=[])}})),
        [CUBE],
    ),
    "box": (box(FRAME, xsize=4, ysize=1, zsize=2), [((1.5, -2, -1), (2.5, 2, 1))]),
    "box of an element": (
        model(
            element(
                moved(1), box(typed("compas.geometry/Frame", **FRAME), xsize=1, ysize=1, zsize=1)
            )
        ),
        [((2.5, -0.5, -0.5), (3.5, 0.5, 0.5))],
    ),
    "polyhedron": (typed("compas.geometry/Polyhedron", **POLYHEDRON), [((0, 0, 0), (1, 1, 2))]),
    "older model": (
        typed("x/BlockModel", elements=[{**typed("x/Block", shape=mesh()), "guid": "g"}], tree={}),
        [CUBE],
    ),
    "older assembly": (
        dict(node={"0": dict(block=dict(dtype="x/Block", value=mesh()["data"]))}),
        [CUBE],
    ),
}


def write(path, value):
    path.write_text(value if isinstance(value, str) else json.dumps(value))
    return path


@mark.parametrize("name", READ)
def test_stones_stand_where_the_file_says(tmp_path, name):
    value, expected = READ[name]
    found = fromFile(write(tmp_path / "a.json", value))
    assert [(b.low, b.high) for b in found] == [(approx(a), approx(b)) for a, b in expected]


STONE = dict(density=2100, Ecm=None)
LAW = typed("compas_dem.interactions/MohrCoulomb", mu=0.5)
#: A problem of two elements whose nodes are in the other order.
PROBLEM = typed(
    "compas_dem.problem/Problem",
    model=model(
        element(is_support=True),
        element(moved(dz=1), material="m"),
        materials=dict(m=typed("compas_dem.material/Stone", **STONE)),
        graph=dict(node={"0": dict(element="1"), "1": dict(element="0")}, edge={}),
    ),
    boundary_conditions=typed("x/BoundaryConditions", gravity=True, g=9.81, point_loads=[{}]),
    contact_properties=typed("x/ContactProperties", contact_model=LAW, joint_model=None),
)


def test_what_a_problem_says_beside_stones_is_kept_with_a_note(tmp_path, capsys):
    path = write(tmp_path / "a.json", PROBLEM)
    found = readCompas(path)
    below, above = found.stones
    assert (below.isSupport, below.node, below.material) == (True, 1, {})
    assert (above.isSupport, above.node, above.material) == (False, 0, STONE)
    assert found.contact["contact_model"] == LAW and found.conditions["gravity"] is True
    assert {b.part for b in fromFile(path)} == {"stone"}
    note = "supports (1), density 2100 kg/m³, MohrCoulomb, point_loads: bricks.readCompas"
    assert note in capsys.readouterr().out
    fromFile(write(path, mesh()))
    assert not capsys.readouterr().out


LOST = dict(root=dict(children=[dict(element="7")]))
REFUSED = [
    (typed("compas.geometry/Sphere", radius=1, frame={}), "Sphere is no mesh, box or polyhedron"),
    (dict(dtype="compas.geometry/Point", data=[0, 0, 0]), "Point is no solid"),
    (model(element(geometry=typed("compas.geometry/Brep", faces=[]))), "Brep is no mesh"),
    (model(typed("compas_model.elements/Beam", width=1)), "element 0: a Beam without a mesh"),
    (model(element(typed("compas.geometry/Shear", angle=1))), "Shear has no matrix"),
    (model(element(moved(dz=float("nan")))), "places no solid"),
    (model(element(moved(turn=3 * [(0, 0, 0)]))), "places no solid"),
    (model(element("up")), "'up' has no matrix"),
    (model(element(), tree=[dict(element="7")]), "an element '7' that is none"),
    (model(element(), graph=dict(edge={"0": {"1": dict(modifiers=[typed("x/Cut")])}})), "Cut"),
    (model(*2 * [element(geometry=FLAT)]), "stone 1: .* more such edges|the solid is open"),
    (box(FRAME, xsize=1, ysize="2", zsize=3), "sides of a box"),
    (box(FRAME, xsize=1, ysize=1), "cannot be read"),
    (assembly([]), "no mesh, box or polyhedron"),
    (dict(elements=[3]), "cannot be read"),
    (dict(elements={"0": None}), "cannot be read"),
    (dict(vertex={"0": {"x": True}}, face={}), "no point of three"),
    ("[" * 100_000, "cannot be read"),
    ("[]", "no mesh"),
]


@mark.parametrize("value, said", REFUSED, ids=range(len(REFUSED)))
def test_what_is_no_stone_is_refused_by_its_name(tmp_path, value, said):
    with raises(ValueError, match=said) as refused:
        fromFile(write(tmp_path / "a.json", value))
    assert str(refused.value).isprintable()


@settings(max_examples=150, deadline=None)
@given(some.data())
def test_a_damaged_file_is_read_or_refused(tmp_path_factory, data):
    """A value anywhere in a problem is another one."""
    value = json.loads(json.dumps(PROBLEM))
    holder, key = value, "data"
    for _ in range(data.draw(some.integers(0, 12))):
        inner = holder[key]
        if not isinstance(inner, (dict, list)) or not inner:
            break
        holder = inner
        key = data.draw(
            some.sampled_from([*inner] if isinstance(inner, dict) else range(len(inner)))
        )
    holder[key] = data.draw(
        some.none() | some.booleans() | some.floats() | some.text() | some.just([]) | some.just({})
    )
    path = write(tmp_path_factory.mktemp("damaged") / "a.json", value)
    try:
        fromFile(path)
    except ValueError as error:
        assert str(error).isprintable()
