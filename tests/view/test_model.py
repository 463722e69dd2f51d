# SPDX-License-Identifier: GPL-2.0-or-later
"""The model of the 3-D picture, and the pages that are made of it."""

from usual import *
import base64
import zlib
from masonry.numbers import frames
from masonry_view import page, viewer

from masonry_view.model import BRICK, MIN_FRAMES, MAX_PLACES, PLATEN, Model, chosenFrames, turned
from masonry_view.page import data, library
from pages import HOSTILE, SHOWN, Page
import made_runs
from made_runs import axis

L, T, H = 0.2, 0.1, 0.08  # [m] of a brick
BOX = [(x, y, z) for x in (0, L) for y in (0, T) for z in (0, H)]
#: How the upper block moves from frame to frame: its shift [m], and the axis and angle of its
#: rotation [rad].
STEPS = [
    ((0, 0, 0), (0, 0, 1), 0.0),
    ((1e-4, 0, 2e-4), (0, 1, 0), 1e-3),
    ((3e-3, -1e-3, 5e-3), (0.6, 0, 0.8), 0.3),
    ((0.01, 0, 0.02), (0, 0.6, -0.8), 3.1),
]


def rotation(axis, angle):
    x, y, z = axis
    cross = np.array([(0, -z, y), (z, 0, -x), (-y, x, 0)])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def test_faces_are_the_same_in_both_layouts_of_vtk():
    """Cells 0 and 2 are polyhedra, cell 1 is a tetrahedron, which has no faces of its own."""
    dice = random.Random(2)
    faces = [[dice.randrange(9) for _ in range(3)] for _ in range(9)]
    own, stored = {0: faces[:4], 1: [], 2: faces[4:]}, dice.sample(range(9), 9)
    lists = [[len(f), *(n for face in f for n in (3, *face))] if f else [] for f in own.values()]
    old = {
        "faces": np.concatenate(lists).astype(int),
        "faceoffsets": np.cumsum([len(l) for l in lists]),
    }
    new = {
        "face_connectivity": np.array([faces[n] for n in stored]).ravel(),
        "face_offsets": np.arange(3, 28, 3),
        "polyhedron_to_faces": np.argsort(stored),
        "polyhedron_offsets": np.cumsum([len(f) for f in own.values()]),
    }
    triangles, owners = frames._newFaces(new)
    assert triangles.tolist() == faces
    found = [*frames._oldFaces(old, [0, 2])]
    assert np.concatenate([f for f, _ in found]).tolist() == faces
    assert owners.tolist() == np.concatenate([o for _, o in found]).tolist()


def writeRun(folder, **message):
    rows = [[k, k / 10, 5 * k] for k in range(len(STEPS))]
    figure = {
        "x": axis("displacement_mm", "displacement of the top [mm]"),
        "y": [axis("base_shear_kN", "supports")],
        "y_label": "force [kN]",
    }
    message = {"title": "two bricks", "figure": figure, **message}
    return made_runs.writeRun(
        folder, ["time_s", "displacement_mm", "base_shear_kN"], rows, **message
    )


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A block on another that is a platen, moved as STEPS says, frame by frame."""
    from masonry import MasonryJoint, MasonryMat, addBlock, connect, engines
    from yade import O, Quaternion, Vector3
    from yade.wrapper import MasonryVtkRecorder

    O.reset()
    folder = tmp_path_factory.mktemp("recorded")
    brick = MasonryMat(young=4.8e9, poisson=0.16, density=1800)
    for z in (0, H):
        addBlock([(x, y, v + z) for x, y, v in BOX], brick)
    for body in O.bodies:
        body.state.blockedDOFs = "xyzXYZ"
    engines([MasonryJoint(name="bed", cap=False, tensileStrength=0.1e6)], rows=3)
    connect()
    O.dt = 1e-7
    recorder = MasonryVtkRecorder(directory=str(folder))
    upper = O.bodies[1].state
    for shift, axis, angle in STEPS:
        upper.pos = upper.refPos + Vector3(*shift)
        upper.ori = Quaternion(Vector3(*axis), angle)
        O.step()  # the law sees where the block is
        recorder()
    O.reset()
    times = folder / "joints.pvd"
    number = iter(range(len(STEPS)))
    times.write_text(
        re.sub(r'timestep="[^"]*"', lambda _: f'timestep="{next(number)}"', times.read_text())
    )
    return folder


@pytest.fixture
def run(recorded, tmp_path):
    for path in recorded.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    writeRun(tmp_path, parts={"wall": [1]})
    return tmp_path


# -- motions ---------------------------------------------------------------------------------------


#: Of numbers in frames, over them.
ROUNDED = 2.0**-24


def test_blocks_move_as_the_recorder_says(run):
    model = Model(run)
    assert model.rigid.all() and list(model.looks) == [PLATEN, BRICK]
    assert np.abs(model.shift[:, 0]).max() < 1e-15
    for k, (shift, axis, angle) in enumerate(STEPS):
        frame = frames.readFrame(run, "blocks", k)
        apart = 1e-14 + 2 * ROUNDED * np.abs(frame["displacement"]).max()
        assert model.shift[k, 1] == approx(shift, abs=apart)
        assert model.turn[k, 1] == approx(angle * np.array(axis), abs=1e-12 + 2 * apart / H)
        assert model.displacements(k) == approx(frame["displacement"], abs=apart)


def sides(model, k):
    """Displacements of the corners of joints with their first and with their second blocks."""
    blocks = model.joints.between[model.joints.owner].T
    return [model.displacementsOf(k, block, model.joints.corners) for block in blocks]


def test_joints_are_on_the_faces_of_both_of_their_blocks(run):
    """Also where the blocks have parted: a face moves with its own block alone."""
    model = Model(run)
    joints = model.joints
    assert joints.count == len(joints.between) == 9 and joints.moved is None
    for k, (shift, axis, angle) in enumerate(STEPS):
        lower, upper = sides(model, k)
        assert np.abs(lower).max() < 1e-15
        arms = joints.corners - (L / 2, T / 2, 1.5 * H)
        moved = arms @ rotation(axis, angle).T + shift - arms
        frame = frames.readFrame(run, "joints", k)
        apart = 1e-14 + 2 * ROUNDED * np.abs(frame["second_displacement"]).max()
        assert upper == approx(moved, abs=1e-13 + apart)
        assert lower == approx(frame["displacement"], abs=1e-14)
        assert upper == approx(frame["second_displacement"], abs=apart)
        assert joints.opening[k] == approx(frame["opening"])
        assert joints.slide[k] == approx(np.linalg.norm(frame["slide"], axis=1))


def test_a_joint_may_get_other_points_and_may_go_during_a_run(run, monkeypatch):
    """Each point is shown in the frames that have it."""
    real = frames.readFrame
    ofCorners = ("points", "displacement", "second_displacement")

    def other(directory, kind, number, names):
        frame = real(directory, kind, number)
        if kind == "joints" and number == 2:
            # the points of the first row have moved, and the others are gone
            frame = {n: v if n in ofCorners else v[:3] for n, v in frame.items()}
            frame["points"] = frame["points"] + 1e-3
        return frame

    monkeypatch.setattr(sys.modules["masonry_view.model"], "readFrame", other)
    joints = Model(run).joints
    assert joints.kind.shape == (len(STEPS), 12)
    shown = (joints.kind > 0).sum(axis=1)
    assert shown.tolist() == [0, 9, 3, 9]


def test_frames_are_chosen_so_that_a_report_stays_small():
    assert chosenFrames(13, 1224) == list(range(13))
    for count, blocks in ((200, 1224), (40, 10_000), (300, 100_000)):
        found = chosenFrames(count, blocks)
        assert found[0] == 0 and found[-1] == count - 1
        assert len(found) == max(MIN_FRAMES, MAX_PLACES // blocks)
        steps = np.diff(found)
        assert steps.min() >= 1 and steps.max() - steps.min() <= 1


def test_a_turn_of_any_size_moves_points_as_its_matrix_does():
    arms = np.random.default_rng(1).normal(size=(50, 3))
    axis = np.array((2, -1, 2)) / 3
    for angle in (0.0, 1e-12, 1e-5, 0.7, math.pi, 6.0):
        turns = np.tile(angle * axis, (50, 1))
        expected = arms @ (rotation(axis, angle) - np.eye(3)).T
        assert turned(turns, arms) == approx(expected, abs=1e-14)
    # a small turn keeps all its digits
    small = turned(np.array([[0, 0, 1e-13]]), np.array([[1.0, 0, 0]]))
    assert small[0, 1] == approx(1e-13, rel=1e-12)


def test_surfaces_look_outwards_and_are_closed_and_edges_are_drawn_where_they_bend(run):
    model = Model(run)
    a, b, c = (model.points[model.triangles[:, k]] for k in range(3))
    assert (np.cross(a, b) * c).sum() / 6 == approx(2 * L * T * H)
    ends = model.points[model.edges]
    assert (np.abs(ends[:, 0] - ends[:, 1]) > 1e-9).sum(axis=1).tolist() == [1] * 24


def test_captions_have_the_numbers_of_curve_csv_with_their_units(run):
    captions = Model(run).captions()
    assert captions[2]["values"] == ["displacement of the top: 0.2 mm", "supports: 10 kN"]
    assert captions[2]["stage"] is None  # run.json says nothing about stages
    stages = [
        {"stage": "settle", "steps": 100, "seconds": 1},
        {"stage": "push", "steps": 200, "seconds": 1},
    ]
    writeRun(run, stages=stages, time_step_s=0.01)
    found = [caption["stage"] for caption in Model(run).captions()]
    assert found == ["settle", "settle", "push", "push"]


def test_the_displacement_of_a_ground_is_taken_off_all_blocks(run):
    whole = Model(run)
    writeRun(run, reference_body=1)
    model = Model(run)
    frame = frames.readFrame(run, "blocks", 2)
    mean = frame["displacement"][model.owner == 1].mean(axis=0)
    assert model.displacements(2) == approx(whole.displacements(2) - mean)


# -- the page --------------------------------------------------------------------------------------


def test_numbers_in_a_page_are_those_of_the_run_to_half_a_step(run):
    model = Model(run)
    head, text = data.dataOf(run)
    body, found = zlib.decompress(base64.b64decode(text)), {}
    for name, about in head["arrays"].items():
        values = np.frombuffer(body, "<" + about["kind"], about["count"], about["at"])
        found[name] = values * about["step"]
    count = len(STEPS)
    assert found["triangles"].reshape(-1, 3).tolist() == model.triangles.tolist()
    assert found["points"].reshape(-1, 3) == approx(model.points, abs=1e-7)
    for name, values in (("shift", model.shift), ("turn", model.turn)):
        step = np.abs(values).max() / 32767
        assert head["arrays"][name]["step"] == approx(step)
        assert np.abs(found[name].reshape(values.shape) - values).max() <= 0.51 * step
    for name in ("opening", "slide"):
        values = np.clip(getattr(model.joints, name), 0, None)
        assert np.abs(found[name].reshape(count, -1) - values).max() <= 0.51 * values.max() / 4000
        assert head["values"][name]["most"] == approx(values.max())
    assert found["kind"].reshape(count, -1).tolist() == model.joints.kind.tolist()
    assert [f["time"] for f in head["frames"]] == model.times
    assert head["first"] == count - 1 and data.dataOf(run, 1)[0]["first"] == 1


@mark.parametrize(
    "value, expected", [(12.01, 16), (1, 1), (1.0000000001, 1), (0.00021, 0.00024), (9, 10)]
)
def test_legends_end_at_round_numbers(value, expected):
    assert data.nice(value) == approx(expected)


needsThree = mark.skipif(
    not any(os.path.exists(os.path.join(p, library.COPYRIGHT)) for p in library.PLACES),
    reason="three.js is not installed (apt-get install --no-install-recommends libjs-three)",
)


@needsThree
def test_what_stands_in_files_of_a_run_is_text_in_its_page(run):
    plain = Page(page.page(run))
    figure = {
        "x": axis("displacement_mm", HOSTILE),
        "y": [axis("base_shear_kN", HOSTILE)],
        "y_label": HOSTILE,
    }
    stages = [{"stage": HOSTILE, "steps": 300, "seconds": 1}]
    writeRun(run, title=HOSTILE, figure=figure, stages=stages, time_step_s=0.01)
    text = page.page(run)
    hostile = Page(text)
    assert hostile.names() == plain.names()
    assert hostile.of("title") == hostile.of("h1") == [SHOWN]
    head = json.loads(hostile.of("script")[-2])
    assert head["title"] == head["frames"][0]["stage"] == SHOWN
    assert SHOWN in head["frames"][0]["values"][0]
    assert "alert(1)</script>" not in text


@needsThree
def test_a_page_is_one_file_with_its_library_and_its_licence(run, tmp_path):
    path = tmp_path / "wall.html"
    page.write(run, str(path))
    text = path.read_text()
    for words in ("three.js authors", "License: Expat", "THE SOFTWARE IS PROVIDED"):
        assert words in text
    written = Page(text)
    assert all(one.startswith("data:") for one in written.loads())
    assert "url(" not in written.of("style")[0]


@needsThree
def test_a_notebook_gets_the_page_in_a_frame_that_reaches_nothing(run):
    picture = page.show(str(run), height=400)
    ((tag, attributes, _),) = Page(picture._repr_html_()).elements
    assert tag == "iframe" and attributes["sandbox"] == "allow-scripts"
    assert attributes["srcdoc"] == picture.page == page.page(run)
    assert "height:400px" in attributes["style"]
    with raises(Refused, match="show: height 10 must be a whole number from 200 to 5000"):
        page.show(str(run), height=10)


def test_without_three_the_package_is_named(run, monkeypatch):
    monkeypatch.setattr(library, "PLACES", ("/nowhere",))
    with raises(Refused, match="apt-get install --no-install-recommends libjs-three"):
        page.page(run)


# -- what is refused -------------------------------------------------------------------------------


def test_folders_without_frames_are_refused_with_the_reason(tmp_path):
    with raises(Refused, match="run.json: No such file or directory"):
        Model(tmp_path / "nowhere")
    for options, words in (
        ({"lean": True}, "was started with --lean$"),
        ({"no_vtk": True}, "was started with --no-vtk$"),
        ({}, "has no frames to show: no file blocks_"),
    ):
        writeRun(tmp_path, options=options)
        with raises(Refused, match=words):
            Model(tmp_path)


def test_a_frame_that_a_kill_kept_out_of_the_list_is_not_shown(run):
    text = (run / "joints.pvd").read_text()
    lines = text.splitlines(True)
    last = max(n for n, line in enumerate(lines) if "<DataSet" in line)
    (run / "joints.pvd").write_text("".join(lines[:last] + lines[last + 1 :]))
    assert len(Model(run).times) == len(STEPS) - 1


def cut(run):
    path = run / "blocks_0002.vtu"
    path.write_bytes(path.read_bytes()[:500])


@mark.parametrize(
    "damage, words",
    [
        (cut, "blocks_0002.vtu: it holds no frame"),
        (
            lambda run: (run / "joints_0003.vtp").unlink(),
            "joints.pvd lists 4 frames, and there are 4 files blocks_.*3 files joints_",
        ),
        (lambda run: writeRun(run, reference_body=9), "names body 9, which is not in the frames"),
        (lambda run: writeRun(run, parts=[1, 2]), "not the files of a finished run"),
        (lambda run: writeRun(run, parts={"a": [[1, 2], [3]]}), "not the files of a finished run"),
        (
            lambda run: writeRun(run, stages=[{"steps": 1}], time_step_s=3.0),
            "not the files of a finished run",
        ),
    ],
)
def test_damaged_and_foreign_files_are_refused_in_a_sentence(run, damage, words):
    for number in (-1, 4, 99):
        with raises(Refused, match=f"is no frame {number}; its frames are 0 to 3"):
            data.dataOf(run, number)
    damage(run)
    with raises(Refused, match=words):
        data.dataOf(run)


@needsThree
@mark.parametrize(
    "words, message",
    [
        (["nowhere", "--html", "a.html"], "cannot read nowhere/run.json: No such file"),
        (["RUN", "--html", "no/a.html"], "cannot write no/a.html: there is no folder no"),
        (["RUN", "--html", "RUN"], "is a folder; name a file that ends in .html or .htm"),
        (["RUN", "--html", "link.html"], "cannot write link.html: it is a symbolic link"),
        (["RUN", "--html", "a.obj"], "a.obj must end in .html or .htm"),
        (["RUN", "--html", "a.html", "--at", "9mm"], "never comes to 9 mm"),
    ],
)
def test_what_cannot_be_written_is_refused_and_nothing_is(
    run, tmp_path_factory, monkeypatch, capsys, words, message
):
    here = tmp_path_factory.mktemp("here")
    monkeypatch.chdir(here)
    (here / "link.html").symlink_to("elsewhere")
    assert viewer.main([str(run) if w == "RUN" else w for w in words]) == 2
    assert message in capsys.readouterr().err
    assert sorted(os.listdir(here)) == ["link.html"]


@needsThree
def test_the_program_writes_a_page_into_the_folder_or_elsewhere(run, tmp_path, capsys):
    assert viewer.main([str(run), "--html"]) == 0
    assert "view.html: 0." in capsys.readouterr().out
    first = json.loads(Page((run / "view.html").read_text()).of("script")[-2])
    assert first["first"] == 3
    path = tmp_path / "a.html"
    assert viewer.main([str(run), "--html", str(path), "--at", "0.2mm"]) == 0
    assert json.loads(Page(path.read_text()).of("script")[-2])["first"] == 2
    # not into a folder that may lead elsewhere
    (run / "view.html").unlink()
    (run / "view.html").symlink_to("elsewhere")
    assert viewer.main([str(run), "--html"]) == 2
    assert "view.html, a symbolic link" in capsys.readouterr().err
