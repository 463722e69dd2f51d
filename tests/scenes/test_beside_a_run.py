# SPDX-License-Identifier: GPL-2.0-or-later
"""What is computed beside a run never ends it: an unexpected error there is a note of the run, and
its traceback stands in errors.log."""

from usual import *

#: Plants a fault: a statement is carried out in a module as soon as that is imported.
PLANTS = """
import importlib.machinery, os, signal, sys

def fails(*words, **settings):
    raise TypeError("planted")

def failsInCompanion(act):
    def planted(*words, **settings):
        isCompanion = sys.modules["masonry.run.accuracy"]._isCompanion
        return (fails if isCompanion else act)(*words, **settings)
    return planted

def kills(*words, **settings):
    os.kill(os.getpid(), signal.SIGKILL)

PLANTED = {act.__name__: act for act in (fails, failsInCompanion, kills)}

class Planted(importlib.machinery.PathFinder):
    @classmethod
    def find_spec(cls, name, path=None, target=None):
        if name != os.environ["MODULE"]:
            return None
        spec = super().find_spec(name, path, target)
        load = spec.loader.exec_module
        def loaded(module):
            load(module)
            names = vars(module) | PLANTED
            exec(os.environ["FAULT"], names)
            vars(module).update(names)
        spec.loader.exec_module = loaded
        return spec

sys.meta_path.insert(0, Planted)
"""
SCENE = """
from masonry import Scene, bricks, materials
scene = Scene("pier", bricks.Wall(0.44, 0.162), materials.calciumSilicate(), until=0.1)
base, top = scene.platen("bottom"), scene.platen("top", rotation="held")
scene.press(top, 0.3e6)
scene.settle()
scene.push(top)
scene.finish()
"""
ACCURACY = ["--accuracy", "20", "--lean"]


@mark.parametrize(
    "module, fault, note, words",
    [
        ("masonry_limit.bound", "Bound.describe = fails", "limit analysis of top along x", []),
        (
            "masonry_limit.bound",
            "Bound.describe = fails",
            "limit analysis of top",
            ["--preset=bound"],
        ),
        ("masonry_limit.bound", "Bound.save = fails", "the mechanism of limit analysis", []),
        ("masonry.model.arrays", "beside = fails", "limit analysis", []),
        ("masonry.scene.outcome", "figureOf = fails", "what curve.png shows", []),
        ("masonry_view.curve_figure", "curve = fails", "the figures", []),
        ("masonry_view.figures", "drawRun = kills", "figures and report", []),
        ("masonry_view.report", "read = kills", "figures and report", []),
        ("masonry_view.report", "page = fails", "the report", []),
        ("masonry.run.frame_writer", "Frames._write = fails", "a frame for ParaView", []),
        (
            "masonry.run.frame_writer",
            "Frames._write = fails; SLOW_FRAME = -1",
            "a frame for ParaView",
            [],
        ),
        ("masonry.run.accuracy", "answers = fails", "--accuracy", ACCURACY),
        (
            "masonry.scene.outcome",
            "ResultSummary.summarise = failsInCompanion(ResultSummary.summarise)",
            "--accuracy",
            ACCURACY,
        ),
    ],
)
def test_an_error_beside_a_run_is_a_note_and_its_traceback_a_log(
    tmp_path, module, fault, note, words
):
    (tmp_path / "sitecustomize.py").write_text(PLANTS)
    (tmp_path / "pier.py").write_text(SCENE)
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    planted = dict(MODULE=module, FAULT=fault)
    env = {**os.environ, **planted, "PYTHONPATH": path}
    command = [sys.executable, "pier.py", "--out", "out", *words]
    done = ran(command, cwd=tmp_path, env=env, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    out = tmp_path / "out"
    run = json.loads((out / "run.json").read_text())
    assert "error" not in run and run.get("ended", "done") == "done"
    (said,) = [one["text"] for one in run["notes"] if one["text"].startswith(f"note: {note}")]
    assert said in done.stdout and "errors.log has the traceback" in said
    assert "--preset=bound" in words or len((out / "curve.csv").read_text().splitlines()) > 9
    log = (out / ("accuracy" if "no ±" in said else ".") / "errors.log").read_text()
    assert said.removeprefix("note: ") in log and "Traceback" in log
    if "describe" in fault:
        assert run["bounds"][0]["note"] == said.removeprefix("note: ")
