# SPDX-License-Identifier: GPL-2.0-or-later
"""What a run says while it goes on stands in run.json and in the report, with the stage in which it
was said."""

from hosted import *
from masonry import terminal
from masonry_view import report

UNREST = "note: the structure is not at rest after"
PRESSED = "warning: press: 0.3 Pa: is it in Pa, not MPa?"


def carried(folder):
    """A block on a platen that is pushed, and has no time to come to rest: its run.json."""
    stones = materials.dry(5.0, normalStiffness=1e11)
    scene = standing(folder, bricks.stack(1, (0.4, 0.3, 0.6)), stones, rate=10)
    top = scene.platen("top", rotation="free")
    scene.press(top, 0.3)  # which looks like MPa
    pushed = scene.handle(0, "pushed")
    scene.settle()
    scene.push(pushed, 0.1)
    scene.load(top, (0, 0, -5e3), longest=0.002)
    scene.push(pushed, 0.1)
    scene.finish()
    return readRun(folder)


def test_notes_stand_in_run_json_with_their_stage(tmp_path):
    run = carried(tmp_path)
    notes = run["notes"]
    (warned,) = [one for one in notes if one["text"].startswith(PRESSED)]
    assert (warned["stage"], warned["number"], warned["time_s"]) == ("", 0, 0)
    (moving,) = [one for one in notes if UNREST in one["text"]]
    assert (moving["stage"], moving["number"]) == ("load", 3)
    times = readCurve(tmp_path)["time_s"]
    assert times[run["stages"][2]["first_row"]] == approx(moving["time_s"])
    assert moving["time_s"] < times[-1]
    assert len({one["text"] for one in notes}) == len(notes)
    page = report.page(report.read(str(tmp_path)))
    assert PRESSED in page and page.index("What the run said") < page.index(UNREST)


def test_a_scene_does_not_have_the_notes_of_the_one_before(tmp_path):
    terminal.say("note: of nobody")
    texts = lambda: [one["text"] for one in carried(tmp_path)["notes"]]
    first = texts()
    first.remove("note: of nobody")
    assert texts() == first
