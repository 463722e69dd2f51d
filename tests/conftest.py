# SPDX-License-Identifier: GPL-2.0-or-later
"""Rings, fastest first: common, law, motion, blocks, contact, files (C++, doctest), gates, host,
package, then those below.

Those of C++, the gates and some files of the package ring need no YADE, and run where it is not
installed. All others have the installed YADE in this process; without it they are skipped, with
that reason. Tests marked ``slow`` stand at the end, whatever their ring, and the quick ring
(``scripts/test.sh quick``) leaves them out. With pytest-xdist every worker has a YADE of its own;
what shares an expensive fixture stays in one worker (``--dist loadgroup``).
"""

import contextlib
import glob
import importlib
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import warnings

import pytest
from hypothesis import HealthCheck, settings

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILD = os.path.join(ROOT, "build")
RINGS = [
    "common",
    "law",
    "motion",
    "blocks",
    "contact",
    "files",
    "gates",
    "host",
    "package",
    "sanitizers",
    "fuzz",
    "limit",
    "capacity",
    "view",
    "study",
    "scenes",
]
SLOW = ["sanitizers", "fuzz", "view", "study", "scenes"]  # rings of which every test is slow
#: Rings, and files of other rings, that need no YADE.
WITHOUT_YADE = ["common", "law", "motion", "blocks", "contact", "files", "gates", "capacity"]
WITHOUT_YADE += ["view/test_measure.py", "view/test_report_content.py"]
WITHOUT_YADE += [
    f"package/test_{name}.py"
    for name in """
    accelerograms bricks bricks_checks bricks_files bricks_vaults compare_builds compare_loops
    compas_files cycles loops measured_loops plain_wall stones
    """.split()
]
#: Fixtures that many tests share.
TOGETHER = {"programs", "targets", "squat", "whole", "site"}

#: Tests that take some seconds to a minute each, and of which others try a part:
#: ``scripts/test.sh`` leaves them out, with the site, the sanitizers and what needs a browser.
#: ``scripts/test.sh long`` runs these alone, ``scripts/test.sh all`` both.
LONG = [
    "test_a_quick_case_holds_its_limits_or_says_why_not",
    "test_the_program_of_the_benchmark_prints_its_table",
    "test_companions_end_with_the_run_and_the_same_command_goes_on",
    "test_a_run_that_is_resumed_has_its_half_widths_too",
    "test_every_command_that_has_no_reason_runs",
    "test_a_limit_on_the_size_of_files_fails_rows_in_order",
    "test_ctrl_c_leaves_checkpoints_and_the_study_goes_on",
    "test_kills_at_random_moments_change_no_number",
    "test_interruptions_and_the_order_of_rows_change_no_number",
    "test_walls_at_the_extremes_are_stable_or_stopped_with_a_reason",
    "test_a_push_that_is_too_fast_says_so_and_what_would_do",
    "test_mypy_finds_what_a_user_does_wrong_and_nothing_else",
    "test_what_cannot_be_reached_is_said_with_the_width_that_was_found",
    "test_slurm_gives_the_same",
    "test_a_task_of_slurm_runs_the_levels_of_a_record",
    "test_no_bytes_break_a_reader",
    "test_random_tries_beside_a_run_do_no_harm",
    "test_a_stack_that_falls_has_its_answer_and_a_sentence",
    "test_the_vertical_load_turns_the_wall_about_its_toe_and_keeps_its_line",
    "test_a_wall_of_deformable_units_bends_in_the_page",
    "test_a_wall_of_the_law_goes_on_from_a_checkpoint",
]

#: Tests whose cases take some tenths of a second to a second each: the quick ring has the first
#: case alone.
FIRST_CASE = [
    "test_two_cubes_that_meet_keep_momentum_and_energy_at_any_time_step",
    "test_a_block_that_is_erased_is_an_error_or_left_out",
    "test_a_dry_pier_tips_about_its_toe_or_slides",
    "test_a_forked_process_goes_on",
    "test_a_push_is_the_shear_and_its_lever_arm_the_moment",
    "test_a_run_saved_among_intact_joints_goes_on_in_the_same_bits",
    "test_a_run_that_was_saved_goes_on_in_the_same_bits",
    "test_a_scene_built_anew_goes_on_bit_for_bit",
    "test_an_arch_needs_the_thickness_of_limit_analysis",
    "test_a_step_right_after_a_pause_ends",
    "test_one_couplet_of_seventy_that_is_other_keeps_its_numbers",
    "test_the_bound_of_a_push_lacks_what_dead_loads_push_already",
    "test_the_bound_of_a_tilt_turns_weight_and_not_dead_loads",
    "test_the_section_at_the_foot_has_what_the_base_feels",
    "test_what_outlives_its_scene_raises_an_error_when_read",
    "test_whatever_is_imported_first",
]

#: On a busy machine examples take longer than hypothesis expects, and some are large.
settings.register_profile(
    "busy",
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
settings.load_profile("busy")

sys.path.insert(1, "/usr/lib/x86_64-linux-gnu/yade-double/py")  # as /usr/bin/yade does
sys.path.insert(1, os.path.join(ROOT, "tests", "references"))
sys.path += [
    os.path.join(ROOT, "validation"),
    *sorted(glob.glob(os.path.join(ROOT, "validation", "*", ""))),
]
os.environ.setdefault("OMP_NUM_THREADS", "1")  # as /usr/bin/yade does
if importlib.util.find_spec("masonry") is None:  # nothing is installed
    sys.path.append(os.path.join(ROOT, "scripts"))


def ran(command, **around):
    """A finished process, whose output is text."""
    return subprocess.run(command, capture_output=True, text=True, **around)


def needsYade(path):
    """Whether a file, or any test in a folder, needs YADE."""
    tests = pathlib.Path(ROOT, "tests")
    if path.is_dir():
        return any(map(needsYade, path.rglob("test_*.py")))
    if not path.is_relative_to(tests):
        return True
    name = path.relative_to(tests)
    return name.parts[0] not in WITHOUT_YADE and name.as_posix() not in WITHOUT_YADE


class WithoutYade(pytest.File):
    """A file of tests that cannot be run here."""

    def collect(self):
        pytest.skip("YADE is not installed", allow_module_level=True)


def pytest_pycollect_makemodule(module_path, parent):
    if needsYade(module_path) and "yade" not in sys.modules:
        return WithoutYade.from_parent(parent, path=module_path)


class Cpp(pytest.File):
    """A doctest program: every test case is an item."""

    def collect(self):
        program = os.path.join(BUILD, self.path.stem)
        command = [program, "--list-test-cases", "--no-version"]
        for line in subprocess.check_output(command, text=True).splitlines():
            if line and not line.startswith(("[doctest]", "===")):
                yield CppCase.from_parent(self, name=line, program=program)


class CppCase(pytest.Item):
    def __init__(self, *, program, **kw):
        super().__init__(**kw)
        self.program = program

    def runtest(self):
        pattern = self.name.replace(",", "\\,")
        command = [self.program, "--test-case=" + pattern, "--no-version"]
        run = ran(command)
        if run.returncode or not re.search(r"test cases: +1 \| +1 passed", run.stdout):
            pytest.fail(run.stdout + run.stderr, pytrace=False)

    def reportinfo(self):
        return self.path, 0, self.name


def pytest_collect_file(parent, file_path):
    ring = file_path.parent.name  # one program for all files of a ring
    if file_path.name == f"test_{ring}.cpp":
        return Cpp.from_parent(parent, path=file_path)


def pytest_configure(config):
    given = [pathlib.Path(arg.split("::")[0]).absolute() for arg in config.args]
    # pytest-xdist gives all tests to its workers
    if any(map(needsYade, given)) and config.getoption("dist", "no") == "no":
        # The package registers YADE's classes only if YADE was imported before it, so YADE comes
        # first of all. Its version, which it prints, would stand after pytest's closing line.
        with contextlib.redirect_stdout(None), warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)
            with contextlib.suppress(ModuleNotFoundError):
                importlib.import_module("yade.config")
    for mark in (
        "slow: takes seconds; not in the quick ring",
        "long: takes ten seconds and more, or needs large packages",
        "xdist_group: one worker for all of a name",
    ):
        config.addinivalue_line("markers", mark)


def pytest_collection_modifyitems(items):
    def ring(item):
        parts = item.path.relative_to(os.path.join(ROOT, "tests")).parts
        return parts[0] if parts[0] in RINGS else RINGS[-1]

    seen = set()
    for item in items:
        name = getattr(item, "originalname", None)
        fixtures = set(getattr(item, "fixturenames", []))
        if name in LONG or "site" in fixtures:
            item.add_marker(pytest.mark.long)
        isLater = name in FIRST_CASE and name in seen
        if ring(item) in SLOW or isLater or item.get_closest_marker("long"):
            item.add_marker(pytest.mark.slow)
        seen.add(name)
        for group in TOGETHER & fixtures:
            item.add_marker(pytest.mark.xdist_group(group))
    isSlow = lambda item: item.get_closest_marker("slow") is not None
    items.sort(key=lambda item: (isSlow(item), RINGS.index(ring(item))))


def pytest_terminal_summary(terminalreporter):
    """Tests that were not run, and why, just before the closing line, which counts them among the
    others."""
    reasons = {}
    for report in terminalreporter.stats.get("skipped", []):
        said = report.longrepr
        reason = said[-1] if isinstance(said, tuple) else "no reason"
        reason = reason.removeprefix("Skipped: ")
        reasons[reason] = reasons.get(reason, 0) + 1
    for reason, count in reasons.items():
        terminalreporter.write_line(
            f"NOT RUN: {count} test{'s' * (count > 1)}: {reason}", yellow=True
        )


@pytest.fixture
def scene():
    """An empty YADE scene, empty again afterwards."""
    from yade import O

    O.reset()
    yield O
    O.reset()


def scenePath(name):
    """The path of a program of scripts/ or of its gallery."""
    folders = (os.path.join(ROOT, "scripts", *more) for more in ((), ("gallery",)))
    return next(p for f in folders if os.path.exists(p := os.path.join(f, name + ".py")))


def runProgram(name, *words, check=True, **settings):
    """Run a program of scripts/, or one at a path, in YADE as a user does: the finished process,
    whose output is text."""
    path = name if name.endswith(".py") else scenePath(name)
    process = subprocess.run(
        ["yade", "-n", "-x", path, *map(str, words)],
        **{"capture_output": True, "text": True, "timeout": 300, **settings},
    )
    assert not check or process.returncode == 0, process.stdout + process.stderr
    return process


@pytest.fixture(scope="session")
def comp4(tmp_path_factory):
    """The folder of a run of the wall COMP-4 beyond its peak: a stepped crack from corner to
    corner."""
    folder = str(tmp_path_factory.mktemp("comp4"))
    words = "--preset fast --until 4 --vtk-every 0.5 --out".split()
    runProgram("wall_comp4", *words, folder, timeout=900)
    return folder


@pytest.fixture(scope="module")
def chromium():
    import browser

    with browser.browser() as found:
        yield found


@pytest.fixture
def runScene(tmp_path):
    """Run a program of scripts/ as a user does; returns the finished process and its folder of
    results."""

    def run(name, *options, check=True):
        out = str(tmp_path / "results")
        return runProgram(name, "--out", out, *options, check=check, cwd=tmp_path), out

    return run
