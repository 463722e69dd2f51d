# SPDX-License-Identifier: GPL-2.0-or-later
"""Every command and every snippet of the tutorial, in their order."""

import os
import re
import subprocess

from conftest import ROOT

TUTORIAL = os.path.join(ROOT, "scripts", "TUTORIAL.md")
NAMES = ["window.py", "stack.py", "field.py", "own_brick.py"]


def parts():
    """Snippets and commands of the tutorial in turn, as pairs of which one is empty."""
    with open(TUTORIAL) as f:
        text = f.read()
    return re.findall(r"```python\n(.*?)```|(?m:^    (\S[^\n]*)$)", text, re.S)


def test_every_command_and_snippet(tmp_path):
    for name in ("scripts", "validation"):
        os.symlink(os.path.join(ROOT, name), tmp_path / name)
    names = iter(NAMES)
    ran = 0
    for code, command in parts():
        if code:
            name = next(names)
            (tmp_path / name).write_text(code)
            command = f"yade -n -x {name}" if name == "stack.py" else None
        if not command or not command.startswith(("yade", "/usr/bin", "bash", "for")):
            continue
        if "view.py" in command:  # tests/scenes/test_view.py has ParaView
            continue
        command = command.replace(
            "bash scripts/run.sh couplet", "yade -n -x scripts/couplet.py"
        )
        if "loops" in command:
            scene = (tmp_path / "window.py").read_text()
            cycles = "scene.cycle(top, [1, 2, 4], repeats=2)"
            assert cycles in open(TUTORIAL).read()
            changed = re.sub(r"scene\.push\(top, 5\)", cycles, scene)
            assert changed != scene
            (tmp_path / "window.py").write_text(changed)
            command += " --quick"
        done = subprocess.run(
            command,
            shell=True,
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=280,
        )
        assert done.returncode == 0, command + done.stdout + done.stderr
        assert "rror" not in done.stderr, command + done.stderr
        ran += 1
    assert ran >= 9
    assert (tmp_path / "fan.png").exists() and (
        tmp_path / "results" / "both.png"
    ).exists()
