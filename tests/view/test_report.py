# SPDX-License-Identifier: GPL-2.0-or-later
"""The report that real runs leave: when there is one, and what its reader sees in a real browser.
What it says of a run, tests/view/test_report_content.py compares."""

from hosted import *
import base64
import browser
from browser import BRICK, RED, moved, near, seen, viewed
from masonry_view import report
from masonry.run.drawing_program import DrawingProgram
from small_wall import SMALL, carryOut, parsed

MAX_BYTES = 3e6  # [bytes] of the report of COMP-4


def test_a_run_leaves_its_report_beside_its_figures(tmp_path):
    assert carryOut(SMALL, parsed("--until", "0.3", "--rate", "60", "--out", str(tmp_path))) == 0
    text = (tmp_path / "report.html").read_text()
    run = readRun(tmp_path)
    assert "report.html" in run["files"] and "is not whole" not in text
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", run["date"])
    assert run["warnings"] == [] or all(isinstance(w, str) for w in run["warnings"])
    assert ["base", "platen, held"] in run["held_and_loaded"]
    weights = dict(run["held_and_loaded"])["weight of platens"]
    # 1800 kg/m³, over the wall, 0.2 m high
    area = SMALL.length * SMALL.unit[1]
    assert weights.startswith(f"base {1.8 * 9.81 * 0.2 * area:.4g} kN, top ")
    assert [(t["name"], t["held"]) for t in run["targets"]] == [("base", True), ("top", False)]
    assert ">held<" in text and ">base<" in text  # in the drawing
    assert [word for word, _ in run["script"]] == ["platen", "platen", "press", "settle", "push"]
    assert [stage["load"] and stage["load"][0] for stage in run["stages"]] == [None, "push"]
    rows = readCurve(tmp_path)["displacement_mm"]
    assert 0 <= run["stages"][1]["first_row"] < len(rows)
    assert run["recorded_height_m"] == pytest.approx(SMALL.courses * SMALL.unit[2])
    assert set(run["joint_meanings"]) >= set(run["joint_units"])
    stiffnesses = ["normalStiffness", "shearStiffness"]  # of an elastic joint
    assert run["effective_properties"]["support"] == stiffnesses
    assert "peakRatio" in run["effective_properties"]["bed"]
    # written again from the folder it is the same
    again = tmp_path / "again.html"
    report.write(report.read(str(tmp_path)), str(again))
    assert again.read_text() == text


def test_a_lean_run_leaves_none_and_no_words_for_it(tmp_path):
    words = ["--until", "0.05", "--rate", "60", "--lean", "--out", str(tmp_path)]
    assert carryOut(SMALL, parsed(*words)) == 0
    assert not (tmp_path / "report.html").exists()
    assert "built" not in readRun(tmp_path)


def test_a_run_that_goes_on_has_no_report_of_before(tmp_path, monkeypatch):
    words = ["--rate", "60", "--no-vtk"]
    assert carryOut(SMALL, parsed("--until", "0.1", *words, "--out", str(tmp_path))) == 0
    assert {"report.html", "curve.png"} <= set(os.listdir(tmp_path))
    there = []
    monkeypatch.setattr(
        DrawingProgram, "begin", lambda self, folder: there.extend(os.listdir(folder))
    )
    monkeypatch.setattr(DrawingProgram, "draw", lambda self, folder: None)
    assert carryOut(SMALL, parsed("--until", "0.2", *words, "--resume", str(tmp_path))) == 0
    assert "run.json" in there and not {"report.html", "curve.png"} & set(there)


def test_a_bound_alone_has_a_report_without_a_curve(tmp_path):
    assert carryOut(SMALL, parsed("--preset", "bound", "--out", str(tmp_path))) == 0
    text = (tmp_path / "report.html").read_text()
    assert "There is no curve" in text and "an upper bound" in text
    assert "is not whole" not in text
    assert text.count("data:image/png") == 1  # the mechanism


@pytest.fixture
def pushed(comp4):
    """The report of the wall COMP-4."""
    return os.path.join(comp4, "report.html")


@pytest.fixture
def opened(chromium, pushed):
    return viewed(chromium, pushed)


RING = (
    "(() => { const r = document.querySelector('.now'); return [Number(r.getAttribute('cx')),"
    " Number(r.getAttribute('cy'))] })()"
)


class TestInABrowser:
    pytestmark = browser.needed

    def test_it_opens_without_a_request_or_an_error_and_is_small(self, opened, pushed):
        assert opened.requests == ["file://" + pushed]
        assert opened.problems == []
        assert os.path.getsize(pushed) < MAX_BYTES
        text = opened.value("document.body.innerText")
        assert "TUD-COMP-4" in text and "is not whole" not in text
        assert re.search(r"Peak 11\d(\.\d)? kN at \d\.\d+ mm", text.replace("\u00a0", " "))
        headings = opened.value("[...document.querySelectorAll('h1, h2, h3')].map(h => h.tagName)")
        assert headings[0] == "H1" and headings.count("H1") == 1 and headings.count("H2") == 10

    def test_the_slider_moves_the_picture_and_the_ring(self, opened, tmp_path):
        end = seen(opened, tmp_path, ".masonry-view")
        assert near(end, BRICK) > 0.1 * end[..., 0].size
        last = opened.value(RING)
        moved(opened, 0)
        assert opened.value("view.frame") == 0 and opened.value(RING) != last
        start = seen(opened, tmp_path, ".masonry-view")
        assert near(start, RED) < near(end, RED) / 2
        places = opened.value("document.querySelector('[data-frames]').dataset.frames").split()
        assert len(places) == opened.value("view.head.frames.length")
        moved(opened, 3)
        assert opened.value(RING) == pytest.approx([*map(float, places[3].split(","))])

    def test_a_click_on_the_curve_shows_the_nearest_frame(self, opened):
        moved(opened, 0)
        opened.value("(document.querySelector('[data-frames]').scrollIntoView(), 0)")
        place = opened.value(
            """(() => { const figure = document.querySelector('[data-frames]');
            const chart = figure.querySelector('svg');
            const [x, y] = figure.dataset.frames.split(' ')[4].split(',').map(Number);
            const at = new DOMPoint(x + 2, y).matrixTransform(chart.getScreenCTM());
            return [at.x, at.y] })()"""
        )
        opened.drag(place, place)
        assert opened.value("new Promise(done => setTimeout(() => done(view.frame), 100))") == 4

    def test_all_that_can_be_set_has_a_name_and_all_pictures_have_a_text(self, opened):
        names = opened.value(
            "[...document.querySelectorAll('canvas, input, select, button, summary')].map(e =>"
            " e.getAttribute('aria-label') || (e.labels && e.labels[0] ? e.labels[0].textContent :"
            " e.textContent))"
        )
        assert all(names) and len(names) >= 12
        assert opened.value("[...document.images].every(i => i.alt && i.naturalWidth > 0)")
        assert opened.value(
            "[...document.querySelectorAll('[role=img]')].every(s => s.getAttribute('aria-label'))"
        )
        assert opened.value("document.images.length") == 2  # mechanism and cracks

    def test_it_fits_on_a_narrow_screen_and_on_paper(self, chromium, pushed):
        chromium.open(pushed, width=390, height=780)
        assert chromium.value("document.documentElement.scrollWidth") <= 390
        data = chromium.call("Page.printToPDF", preferCSSPageSize=True)["data"]
        printed = base64.b64decode(data)
        boxes = set(re.findall(rb"/MediaBox ?\[0 0 ([\d.]+) ([\d.]+)\]", printed))
        assert {(round(float(w)), round(float(h))) for w, h in boxes} == {(595, 842)}
        assert 3 <= len(re.findall(rb"/Type\s*/Page\b", printed)) <= 16


@pytest.mark.xdist_group("browser")
def test_the_program_needs_no_yade(comp4, tmp_path):
    path = str(tmp_path / "wall.html")
    code = (
        "import sys; from masonry_view.report.__main__ import main; assert main(sys.argv[1:]) == 0;"
        " assert 'yade' not in sys.modules"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, comp4, "-o", path], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert open(path).read() == open(os.path.join(comp4, "report.html")).read()
