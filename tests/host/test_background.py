# SPDX-License-Identifier: GPL-2.0-or-later
"""Work that a copy of the process does beside a run."""

import atexit

from usual import *
from masonry import background
from masonry.background import Failed, Program, Task
from masonry.errors import Refused, Unwritable


def children():
    """Processes of this one, also those that have ended and were not waited for."""
    with open(f"/proc/self/task/{os.getpid()}/children") as file:
        return file.read().split()


def test_results_come_one_after_the_other_and_no_process_stays():
    before, files = children(), os.listdir("/proc/self/fd")
    large = bytes(3 << 20)

    def work():
        yield os.getpid()
        yield large

    task = Task(work, parts=2)
    assert task.result(1) == large
    assert task.result(0) not in (0, os.getpid())
    assert children() == before and len(os.listdir("/proc/self/fd")) == len(files)


def test_it_goes_on_meanwhile():
    def work():
        time.sleep(0.5)
        yield 1

    began = time.monotonic()
    task = Task(work)
    assert time.monotonic() - began < 0.3 and not task.ready()
    assert task.ready(0, 10) and task.result() == 1


def test_what_it_raises_is_raised_here():
    def work():
        raise Unwritable("cannot write x: No space left on device")
        yield

    with raises(Unwritable, match="cannot write x: No space"):
        Task(work).result()


@mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_one_that_is_killed_is_one_clear_sentence(number):
    before = children()

    def work():
        yield os.getpid()
        time.sleep(60)

    task = Task(work, parts=2)
    os.kill(task.result(), number)
    with raises(Failed, match="its process has ended before its time"):
        task.result(1)
    assert children() == before


def test_one_that_is_dropped_ends():
    before = children()

    def work():
        time.sleep(60)
        yield

    task = Task(work)
    task.end()
    assert children() == before
    task.end()


def test_without_a_process_the_work_is_done_at_once(monkeypatch):
    def refused():
        raise BlockingIOError("no process")

    monkeypatch.setattr(background.os, "fork", refused)
    task = Task(lambda: iter([os.getpid(), 2]), parts=2)
    assert task.ready(1) and task.result(0) == os.getpid() and task.result(1) == 2


def says(text, status):
    """What a program does: it says something, now and at its end, and ends with a status."""

    def act():
        atexit.register(print, "over")
        print(text, os.environ.get("KNOWN"), os.getcwd())
        raise SystemExit(status)

    return act


def fails():
    raise RuntimeError("it was told to fail")


def isKilled():
    os.kill(os.getpid(), signal.SIGKILL)


@mark.parametrize(
    "act, status, said",
    [
        (says("fine", None), 0, "fine here /tmp\nover\n"),
        (says("odd", 7), 7, "odd here /tmp\nover\n"),
        (says("wrong", "in a sentence"), 1, "in a sentence\n"),
        (fails, 1, "RuntimeError: it was told to fail\n"),
        (isKilled, -signal.SIGKILL, ""),
    ],
)
def test_a_program_ends_as_a_script_of_its_own_does(tmp_path, monkeypatch, act, status, said):
    monkeypatch.setenv("KNOWN", "there")
    before = children()
    with open(tmp_path / "log", "wb") as log:
        program = Program(act, log, {"KNOWN": "here"}, "/tmp")
    assert program.wait() == program.poll() == status and children() == before
    assert said in (tmp_path / "log").read_text() and program.refusal() == ("", "")
    assert os.environ["KNOWN"] == "there"


def test_a_parent_reads_what_its_program_refuses(tmp_path):
    def act():
        background.reportRefusal(Refused("--rate -1 must be above 0"))
        return 2

    with open(tmp_path / "log", "wb") as log:
        program = Program(act, log)
    assert program.wait() == 2
    assert program.refusal() == ("Refused", "--rate -1 must be above 0")
