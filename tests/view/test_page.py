# SPDX-License-Identifier: GPL-2.0-or-later
"""The 3-D page of real runs in a real browser, as its user sees it. What a page holds,
tests/view/test_model.py compares."""

from usual import *
import browser
from browser import BRICK, RED, moved, near, seen, viewed
from masonry_view import page
from masonry_view.model import BRICK as BRICK_BLOCK
from masonry_view.model import Model

pytestmark = browser.needed
MAX_BYTES = 3e6  # [bytes] of the page of COMP-4


@pytest.fixture(scope="module")
def paper(comp4, tmp_path_factory):
    """Its page, written as a user does."""
    path = str(tmp_path_factory.mktemp("paper") / "wall.html")
    program = os.path.join(ROOT, "scripts", "view.py")
    done = subprocess.run(
        ["/usr/bin/python3", program, comp4, "--html", path], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return path


@pytest.fixture
def opened(chromium, paper):
    return viewed(chromium, paper)


#: Chooses what the joints show, as the user of the page does.
CHOSEN = """(() => { const labels = [...document.querySelectorAll('label')];
    const list = labels.find(l => l.textContent.startsWith('joints')).querySelector('select');
    list.value = 'slide'; list.dispatchEvent(new Event('change')); return 0 })()"""


def test_the_page_opens_without_a_request_or_an_error_and_is_small(opened, paper):
    assert opened.requests == ["file://" + paper]
    assert opened.problems == []
    assert os.path.getsize(paper) < MAX_BYTES
    text = opened.value("document.body.innerText")
    assert "TUD-COMP-4" in text and "9 of 9" in text and "stage push" in text
    assert re.search(r"displacement of top.*: 4[.\d]* mm", text)
    assert re.search(r"supports: [\d.]+ kN", text)


def test_the_browser_lets_the_page_ask_nobody(opened, tmp_path):
    """Whatever stood in it: a policy in the page forbids it."""
    (tmp_path / "other.json").write_text("{}")
    for address in ("http://127.0.0.1:9/", f"file://{tmp_path}/other.json"):
        assert opened.value(f"fetch('{address}').then(() => 'came', () => 'refused')") == "refused"
    assert len(opened.problems) >= 2
    assert all("Content Security Policy" in text for text in opened.problems)


def test_the_picture_shows_bricks_and_the_crack_that_grows(opened, tmp_path):
    end = seen(opened, tmp_path)
    assert near(end, BRICK) > 0.15 * end[..., 0].size and near(end, RED) > 300
    moved(opened, 0)
    start = seen(opened, tmp_path)
    assert near(start, RED) < near(end, RED) / 5
    assert opened.value("document.body.innerText").count("1 of 9") == 1


def test_legends_have_the_unit_and_the_range_of_what_is_chosen(opened):
    says = lambda: opened.value("view.legend.innerText").split("\n")
    assert says() == ["open > 0.05 mm", "slid > 0.05 mm", "closed > 0.5 mm"]
    opened.value(CHOSEN)
    top = opened.value("view.head.values.slide.top")
    marks = [float(line.removeprefix("≥ ")) for line in says()[1:6]]
    assert says()[0] == "slide [mm]" and says()[6].startswith("from 0.05")
    assert sorted(marks) == pytest.approx([1e3 * top * n / 4 for n in range(5)])


def test_mouse_and_keys_turn_and_zoom(opened):
    where = lambda: opened.value("[...view.directions()[2].toArray(), view.camera.zoom]")
    first = where()
    opened.drag((400, 300), (490, 300))
    assert np.dot(where()[:3], first[:3]) < 0.95
    opened.wheel((300, 200), -400)
    assert where()[3] > 1
    opened.value("(view.canvas.focus(), 0)")
    opened.press("Home")
    assert where() == pytest.approx(first, abs=1e-9)
    opened.press("PageUp")
    assert opened.value("view.frame") == 7 and opened.problems == []


def test_blocks_and_joints_stand_where_the_run_says(opened, comp4):
    """Joints stand on the faces of both of their blocks."""
    model = Model(comp4)
    joints = model.joints
    opened.value("(view.magnify = 1, 0)")
    for k in (0, 5, 8):
        opened.value(f"(view.show({k}), 0)")
        found = np.array(opened.value("[...view.moved]")).reshape(-1, 3)
        expected = model.displacements(k)
        # a step of the shift, and one of the turn for a corner that is at most half a metre from
        # the centre of its brick
        steps = np.abs(model.shift).max() / 32767 + 0.2 * np.abs(model.turn).max() / 32767
        brick = model.looks[model.owner] == BRICK_BLOCK
        assert np.abs(found - expected)[brick].max() < steps
        assert np.abs(found - expected)[~brick].max() < 20 * steps  # 4 m long
        faces = np.array(
            opened.value("[...view.faces.geometry.attributes.position.array]")
        ).reshape(-1, 3)
        shades = np.array(opened.value("[...view.faces.geometry.attributes.color.array]")).reshape(
            -1, 3
        )
        shown = np.flatnonzero(joints.kind[k][joints.owner])
        corners = np.concatenate(
            [
                (joints.corners + model.displacementsOf(k, block, joints.corners))[shown]
                for block in joints.between[joints.owner].T
            ]
        )
        for one in corners[:: max(1, len(corners) // 50)]:
            assert np.abs(faces - one).max(axis=1).min() < 1e-5
        assert len({*map(tuple, np.rint(255 * shades).astype(int))}) == len(
            set(joints.kind[k][joints.kind[k] > 0])
        )


def test_a_click_on_a_block_says_which_it_is_and_how_it_moved(opened, comp4):
    opened.value("(view.look('front'), 0)")
    opened.drawn()
    model = Model(comp4)
    block = 600
    moved = model.shift[-1, block]
    place = opened.value(
        "(() => { const b = view.canvas.getBoundingClientRect(), p = new"
        f" THREE.Vector3(...{(model.centres[block] + 30 * moved).tolist()}).project(view.camera);"
        " return [b.left + (p.x + 1) / 2 * b.width, b.top + (1 - p.y) / 2 * b.height] })()"
    )
    opened.drag(place, place)
    said = opened.value("view.says.innerText")
    found = re.search(r"block (\d+) at \(.*\) m has moved by \((.*)\) mm", said)
    assert int(found[1]) == model.bodies[block]
    assert list(map(float, found[2].split(", "))) == pytest.approx(1e3 * moved, rel=6e-3, abs=2e-3)


def test_a_notebook_shows_the_picture(chromium, comp4, tmp_path):
    path = tmp_path / "notebook.html"
    path.write_text(
        f'<!DOCTYPE html><meta charset="utf-8"><body>{page.show(comp4)._repr_html_()}</body>'
    )
    chromium.problems.clear()
    chromium.open(str(path))
    until = 100
    while near(seen(chromium, tmp_path), BRICK) < 30000 and until:
        until -= 1
    assert until and chromium.problems == []


def test_a_wall_of_deformable_units_bends_in_the_page(chromium, tmp_path):
    folder = str(tmp_path / "out")
    runProgram("wall_comp1", "--blocks", "deformable", "--quick", "--out", folder)
    path = str(tmp_path / "wall.html")
    page.write(folder, path)
    chromium.problems.clear()
    chromium.open(path)
    model = Model(folder)
    assert (~model.rigid).sum() == 340
    found = chromium.value("masonryViews[0].then(v => [...v.moved])")
    expected = model.displacements(len(model.times) - 1)
    step = np.abs(model.moved).max() / 32767
    error = np.abs(np.array(found).reshape(-1, 3) - expected)
    assert error[model.free].max() < 0.51 * step
    assert near(seen(chromium, tmp_path), BRICK) > 10000
    assert chromium.problems == []


def test_without_webgl_a_sentence_stands_in_place_of_the_picture(paper):
    with browser.browser("--disable-3d-apis") as chromium:
        chromium.open(paper)
        assert chromium.value("masonryViews[0]") is None
        text = chromium.value("document.body.innerText")
        assert (
            "This browser shows no 3-D pictures, because WebGL is switched off or missing" in text
        )
        assert chromium.problems == []


def test_damaged_numbers_are_a_sentence_too(chromium, paper, tmp_path):
    text = open(paper).read()
    at = text.index('<script type="text/plain">') + 400
    path = tmp_path / "damaged.html"
    path.write_text(text[:at] + "AAAA" + text[at + 4 :])
    chromium.open(str(path))
    assert "The picture cannot be drawn:" in chromium.value("document.body.innerText")
