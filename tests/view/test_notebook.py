# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene in a notebook: what it shows, how it is interrupted, and how it goes on. Needs the
packages of Jupyter."""

import base64
import io
import queue
from usual import *
from masonry_view import painting
from PIL import Image

pytestmark = mark.slow
jupyter = pytest.importorskip(
    "jupyter_client", reason="jupyter-nbconvert and python3-ipykernel are not installed"
)
pytest.importorskip("ipykernel", reason="python3-ipykernel is not installed")

LARGEST = 150_000  # bytes of what a notebook keeps of one object
SCENE = """
from masonry import Scene, bricks, materials
wall = bricks.Wall(1.1, 0.81)
scene = Scene({name!r}, wall, materials.calciumSilicate(), rate={rate}, out={out!r})
base, top = scene.platen("bottom"), scene.platen("top", rotation="held")
scene.press(top, 0.3e6)
"""


class Kernel:
    """A kernel of Python as a notebook has it."""

    def __init__(self, folder):
        around = dict(kernel_name="python3", cwd=str(folder), startup_timeout=120)
        self.manager, self.client = jupyter.manager.start_new_kernel(**around)

    def ask(self, code, until=None, seconds=120):
        """Run a cell; ``until``: function of a message after which the kernel is interrupted once.
        Returns its messages."""
        sent = self.client.execute(code, allow_stdin=False, stop_on_error=False)
        found = []
        ends = time.monotonic() + seconds
        while time.monotonic() < ends:
            with contextlib.suppress(queue.Empty):
                message = self.client.get_iopub_msg(timeout=1)
                if message["parent_header"].get("msg_id") != sent:
                    continue
                found.append(message)
                if until and until(message):
                    self.manager.interrupt_kernel()
                    until = None
                content = message["content"]
                if content.get("execution_state") == "idle":
                    assert not until, found
                    return found
        raise AssertionError(f"a cell did not end within {seconds} s: {found}")

    def say(self, code, **more):
        """Run a cell that must not fail, and return its messages."""
        found = self.ask(code, **more)
        assert not of(found, "error"), of(found, "error")
        return found


def of(messages, kind):
    return [m["content"] for m in messages if m["msg_type"] == kind]


def printed(messages):
    return "".join(content["text"] for content in of(messages, "stream"))


def shown(messages):
    """The HTML of the value of a cell."""
    (result,) = of(messages, "execute_result")
    page = result["data"]["text/html"]
    assert len(page) < LARGEST, len(page)
    return page


def pictures(page):
    found = re.findall(r'src="data:image/png;base64,([^"]+)"', page)
    found = [base64.b64decode(text) for text in found]
    assert all(data.startswith(b"\x89PNG") for data in found)
    return found


@pytest.fixture
def kernel(tmp_path):
    one = Kernel(tmp_path)
    yield one
    one.client.stop_channels()
    one.manager.shutdown_kernel(now=True)


def test_a_scene_shows_itself_before_between_and_after_its_stages(kernel, tmp_path):
    kernel.say(SCENE.format(name="shown", rate=100, out="shown"))
    page = shown(kernel.say("scene"))
    assert len(pictures(page)) == 1
    texts = "100 in 55 bricks;180 between blocks;1.1 × 0.102 × 0.81 m;100 of 110 × 102 × 81 mm"
    texts += ";platen, held<;pressed by 0.3 MPa;tensileStrength</th><td;kg/m³"
    for text in texts.split(";"):
        assert text in page.replace(' style="text-align:left"', ""), text
    (error,) = of(kernel.ask("scene.push(top, 1)"), "error")
    assert "settle(): call that first" in error["evalue"]
    assert not (tmp_path / "shown").exists()
    progress = kernel.say("scene.settle()")
    (error,) = of(kernel.ask("scene.push(top, -1)"), "error")  # a slip is no end
    assert error["ename"] == "Refused" and "must be above 0" in error["evalue"]
    progress += kernel.say("scene.push(top, 1)")
    lines = [c for c in of(progress, "display_data") if "progress" in str(c)]
    assert len(lines) == 2  # one of each stage
    assert {c["transient"]["display_id"] for c in of(progress, "update_display_data")} <= {
        c["transient"]["display_id"] for c in lines
    }
    assert "steps/s" not in printed(progress)
    page = shown(kernel.say("scene"))
    assert len(pictures(page)) == 2 and "push: peak" in page
    standing = pictures(page)[0]
    kernel.say("scene.finish()")
    page = shown(kernel.say("scene"))
    both = [
        np.asarray(Image.open(io.BytesIO(p)).convert("RGB"), int)
        for p in (standing, pictures(page)[0])
    ]
    # below their titles both show the same: crack surfaces of bricks that are whole are no joints
    assert (np.abs(both[0] - both[1])[50:].max(axis=2) > 50).mean() < 1e-4
    reds = np.abs(both[0] - painting.rgb(painting.CRACKS["open"])).max(axis=2)
    assert (reds < 10).sum() > 50  # open joints have their colour
    assert len(pictures(page)) == 2 and "force at the supports at the peak" in page
    run = json.load(open(tmp_path / "shown" / "run.json"))
    assert f"{run['peak_base_shear_kN']:.4g}" in page
    folder = "from masonry_view.notebook import RunFolder\nRunFolder('shown')"
    assert shown(kernel.say(folder)) == page
    assert len(pictures(shown(kernel.say("scene.curve()")))) == 1
    with open(tmp_path / "shown" / "curve.csv") as f:
        rows = list(csv.DictReader(f))
    check = """
import json
curve = scene.curve()
print(json.dumps([list(curve), curve.units, {n: list(curve[n]) for n in curve}]))
"""
    names, units, values = json.loads(printed(kernel.say(check)))
    assert names == list(rows[0]) and units["base_shear_kN"] == "kN"
    assert units["load_factor"] == "-" and units["top_rotation_mrad"] == "mrad"
    for name in names:
        expected = np.array([float(row[name]) for row in rows])
        # curve.csv has nine digits
        assert np.allclose(values[name], expected, rtol=1e-8, atol=1e-12), name


def test_an_interrupted_run_goes_on_from_a_following_cell(kernel, tmp_path):
    kernel.say(SCENE.format(name="stopped", rate=0.5, out="stopped"))
    for early in ("push(top, 1)", "stepBack()", "result('early', 1)"):
        assert of(kernel.ask(f"scene.{early}"), "error")
    kernel.say("scene.settle()\nscene.result('rest', 1.5, 'mm')")
    seen = []

    def pushes(message):
        seen.append("push  " in str(message["content"].get("data")))
        return sum(seen) > 2

    broken = kernel.ask("print(scene.push(top, 1.5)); print('went on')", until=pushes)
    (error,) = of(broken, "error")
    assert error["ename"] == "Stopped" and len(error["traceback"]) == 1
    assert "scene = scene.resume() goes on" in error["evalue"]
    assert "went on" not in printed(broken)
    assert "interrupted: what was computed is kept" in printed(broken)
    run = json.load(open(tmp_path / "stopped" / "run.json"))
    assert run["interrupted"] and run["displacement_end_mm"] < 1.49
    page = shown(kernel.say("scene"))
    assert "interrupted; its results so far are in" in page
    # another cell can be interrupted as usual
    endless = "print('on', flush=True)\nwhile True: pass"
    found = kernel.ask(endless, until=lambda m: m["msg_type"] == "stream")
    assert of(found, "error")[0]["ename"] == "KeyboardInterrupt"
    assert "done" in str(kernel.say("scene = scene.resume()\nscene.ended"))
    kernel.say("scene.move(base, z=-0.1)\nscene.finish()")
    kernel.say(SCENE.format(name="stopped", rate=0.5, out="whole"))
    kernel.say("scene.settle()\nscene.result('rest', 1.5, 'mm')\nscene.push(top, 1.5)")
    kernel.say("scene.move(base, z=-0.1)\nscene.finish()")
    kept = json.load(open(tmp_path / "stopped" / "run.json"))["answers"]
    assert [a["value"] for a in kept if a["name"] == "rest"] == [1.5]
    curve = lambda name: (tmp_path / name / "curve.csv").read_bytes()
    assert curve("whole") == curve("stopped")
    again = kernel.ask("scene.resume()")
    assert "no run that was interrupted" in of(again, "error")[0]["evalue"]


def test_words_of_the_kernel_stay_and_scenes_follow_each_other(kernel, tmp_path):
    kernel.say("import sys\nbefore = list(sys.argv), list(sys.path)")
    for name in ("one", "two"):
        kernel.say(SCENE.format(name=name, rate=100, out=name))
        kernel.say("scene.settle(); scene.push(top, 0.1); scene.finish()")
        assert (tmp_path / name / "run.json").exists()
    found = printed(kernel.say("print(sys.argv == before[0], sys.path[:3] == before[1][:3])"))
    assert found.split() == ["True", "True"]
    wrong = of(kernel.ask("Scene('three', [], materials.dry(0.6))"), "error")
    assert wrong[0]["ename"] == "Refused"


def test_pandas_that_is_not_there_is_named():
    code = """
import sys
sys.modules["pandas"] = None
from masonry_view.notebook import Curve
try:
    Curve({"time_s": [0, 1]}, {"time_s": "time [s]"}).to_pandas()
except ImportError as error:
    print(error)
"""
    run = ran([sys.executable, "-c", code])
    assert "apt-get install python3-pandas" in run.stdout, run.stderr
    assert "yade" not in run.stdout


def test_the_curve_as_a_frame_of_pandas():
    pytest.importorskip("pandas", reason="python3-pandas is not installed")
    from masonry_view.notebook import Curve

    frame = Curve({"time_s": [0, 1], "own": [2, 3]}, {"time_s": "time [s]"}).to_pandas()
    assert list(frame["own"]) == [2, 3]
    assert frame.attrs["units"] == {"time_s": "s", "own": "-"}
