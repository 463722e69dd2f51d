"""Short runs against the stored numbers of the build that made them; tests/references/references.py says what they are.

The rule of the table: zero, which is bit for bit, unless the order of a sum had to change. Then an instant before the
first crack may differ by 1e-9, a peak by 0.0002 (0.02 %), and a later instant by a number that is written here with its
reason; a collapse is chaotic, so that its late instants say little and its early one must stay tight. A change of the
answers is no reason. What is not named here is zero.
"""

import os
import subprocess

import pytest
import references

FOLDER = references.FOLDER

#: Run -> instant or quantity -> largest relative difference; a quantity goes before an instant.
TOLERANCES = {
    "rigid": {},
    "rigid_combined": {},
    "rigid_space": {},
    "rigid_space_combined": {},
    "rigid_functors": {},
    "rigid_space_functors": {},
    "rigid_resumed": {},
    "rigid_saved": {},
    "deformable": {},
    "deformable_local": {},
    "deformable_space": {},
    "deformable_unlike": {},
    "deformable_space_unlike": {},
    "deformable_functors": {},
    "deformable_resumed": {},
    "deformable_saved": {},
    "couplets": {},
    "couplets_combined": {},
    "couplets_undamped": {},
    "flying": {},
    "flying_combined": {},
    "collapse": {},
    "collapse_space": {},
    "collapse_deformable": {},
    "changes": {},
}


def allowed(run, instant, quantity):
    table = TOLERANCES[run]
    return table.get(quantity, table.get(instant, 0))


@pytest.mark.parametrize("name", references.RUNS)
def test_a_run_gives_the_stored_numbers(scene, name):
    apart = references.differences(name, references.go(name))
    for instant, quantity, size in apart:
        print(f"{instant}: {quantity}: relative difference {size:.2g}")
    within = {
        instant for instant, _, _ in apart if allowed(name, instant, "") > 0
    }  # the fingerprint is of all bits
    wrong = [
        f"{instant}: {quantity} by {size:.2g}, allowed {allowed(name, instant, quantity):.2g}"
        for instant, quantity, size in apart
        if size > allowed(name, instant, quantity)
        or (allowed(name, instant, quantity) == 0 and instant not in within)
    ]
    assert not wrong, f"{name} differs from what is stored:\n" + "\n".join(wrong)


def test_every_run_has_its_tolerances_and_its_file():
    assert list(TOLERANCES) == list(references.RUNS)
    files = {os.path.basename(references.pathOf(name)) for name in references.RUNS}
    there = {f for f in os.listdir(FOLDER) if f.endswith(".json")}
    assert files == there
    assert sum(os.path.getsize(os.path.join(FOLDER, f)) for f in there) < 200e3


@pytest.mark.slow
def test_two_threads_give_the_same_references():
    program = os.path.join(FOLDER, "references.py")
    run = subprocess.run(
        ["yade", "-j2", "-n", "-x", program], capture_output=True, text=True
    )
    assert run.returncode == 0 or any(TOLERANCES.values()), run.stdout + run.stderr
    assert "with 2 threads" in run.stdout and run.stdout.count("left out") == 3
