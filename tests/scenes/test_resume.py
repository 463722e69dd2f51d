# SPDX-License-Identifier: GPL-2.0-or-later
"""Any script of stages, stopped at any step and resumed, leaves what an unbroken run leaves.

``RESUME_SEED`` and ``RESUME_SCRIPTS`` choose the first script, and how many there are.
"""

import os
import random
import signal

import pytest
import stopped

SEED = int(os.environ.get("RESUME_SEED", 1000))
MOST = 20_000  # steps of a script
SCRIPTS = int(os.environ.get("RESUME_SCRIPTS", 20))


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = "displacement_mm\n0\n0.05\n-0.02\n0.08\n"
    (tmp_path / "path.csv").write_text(path)
    return tmp_path


@pytest.mark.parametrize(
    "seed",
    [
        pytest.param(SEED + n, marks=[pytest.mark.long] if n >= SCRIPTS // 4 else [])
        for n in range(SCRIPTS)
    ],
)
def test_a_script_that_is_stopped_and_resumed_leaves_what_an_unbroken_run_leaves(
    here, seed
):
    dice = random.Random(f"{seed} stop")
    for trial in range(100):
        script = stopped.Writer(f"{seed} {trial}").write()
        out = f"whole{trial}"
        status, steps, said = stopped.carryOut(script, "--out", out, most=MOST)
        if status == 0 and steps > 10:
            break
    how, step = dice.choice(
        [signal.SIGTERM, signal.SIGINT, signal.SIGKILL]
    ), dice.randint(1, steps)
    print(f"RESUME_SEED={seed}: {how.name} at step {step} of {steps}\n{script}")
    assert status == 0, said
    if how == signal.SIGKILL:
        stop, out = stopped.killed("stopped", step), "killed"
    else:
        stop, out = stopped.signalled(how, step), "stopped"
    stopped.carryOut(script, "--out", out, stop=stop)
    if how == signal.SIGKILL and not os.path.exists("stopped"):
        return  # it was over before it was killed
    status, _, said = stopped.carryOut(script, "--resume", "stopped")
    assert status == 0, said
    assert (
        stopped.differences(stopped.left(f"whole{trial}"), stopped.left("stopped"))
        == []
    )
