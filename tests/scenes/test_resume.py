# SPDX-License-Identifier: GPL-2.0-or-later
"""Any script of stages, stopped at any step and resumed, leaves what an unbroken run leaves.

``RESUME_SEED`` and ``RESUME_SCRIPTS`` choose the first script, and how many there are.
"""

import os
import random
import signal
import time

import pytest
import stopped

SEED = int(os.environ.get("RESUME_SEED", time.time() // 86400 * 1000))
SCRIPTS = int(os.environ.get("RESUME_SCRIPTS", 20))


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = "displacement_mm\n0\n0.05\n-0.02\n0.08\n"
    (tmp_path / "path.csv").write_text(path)
    return tmp_path


@pytest.mark.parametrize("seed", range(SEED, SEED + SCRIPTS))
def test_a_script_that_is_stopped_and_resumed_leaves_what_an_unbroken_run_leaves(
    here, seed
):
    dice = random.Random(f"{seed} stop")
    for trial in range(100):
        script = stopped.Writer(f"{seed} {trial}").write()
        status, steps, said = stopped.carryOut(script, "--out", f"whole{trial}")
        if status == 0 and steps > 10:
            break
    print(f"RESUME_SEED={seed}\n{script}")
    whole = stopped.left(f"whole{trial}")
    for number, how in enumerate((signal.SIGTERM, signal.SIGINT, signal.SIGKILL)):
        step, out = dice.randint(1, steps), f"stopped{number}"
        act = (
            stopped.killed(f"{out}k", step)
            if how == signal.SIGKILL
            else stopped.signalled(how, step)
        )
        status, _, _ = stopped.carryOut(script, "--out", out, stop=act)
        if how == signal.SIGKILL:
            if status == 0:  # there was no checkpoint yet
                continue
            out += "k"
        print(f"stopped by {how.name} at step {step} of {steps}, in {out}: {status}")
        status, _, said = stopped.carryOut(script, "--resume", out)
        assert status == 0, said
        assert stopped.differences(whole, stopped.left(out)) == []
