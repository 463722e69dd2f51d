# SPDX-License-Identifier: GPL-2.0-or-later
"""tests/references/compare_builds.py finds every change of a number, and allows what it says."""

from usual import *
from compare_builds import Build, Work, compare


def checkpoint(force=1.5, name="damped"):
    """The bytes of a checkpoint with two numbers, one of which has another name or value."""
    extra = json.dumps({"rows": [[0.0, 1.25]], "host": random.random()}).encode()
    records = {"extra": extra, "engines": name.encode(), "time": b"\0" * 8}
    records[name] = np.float64(force).tobytes()
    size = lambda part: len(part).to_bytes(8, "little")
    parts = [b"n" + size(n.encode()) + size(v) + n.encode() + v for n, v in sorted(records.items())]
    return b"masonry checkpoint\n" + b"\0" * 8 + b"".join(parts) + b"\0" * 8


BUILDS = [Build("/one", "/scripts"), Build("/two", "/scripts")]
RUN = """{
 "peak": 1.25, "date": "2026-05-31", "stages": [{"steps": 5, "seconds": 0.1}],
 "source": "masonry.formulas", "out": "FOLDER"
}"""
FILES = {"curve.csv": b"time_s,force_kN\r\n0,1.25\r\n", "run.json": RUN.encode()}
FILES |= {"log.log": b"5 s", "cracks.png": b"\x89PNG\xff\0", "run.checkpoint": checkpoint()}


def compared(tmp_path, changed):
    """Whether two builds are equal of which the second writes other files; None: it writes no such
    file."""

    def writeFiles(attempt):
        isSecond = attempt.build.site == "/two"
        for name, data in {**FILES, **(changed if isSecond else {})}.items():
            if data is not None:
                data = data.replace(b"FOLDER", attempt.folder.encode())
                (tmp_path / attempt.path(name)).write_bytes(data)

    return compare(Work("made", writeFiles), BUILDS, str(tmp_path))


def replaced(name, old, new):
    assert old in FILES[name]
    return {name: FILES[name].replace(old, new)}


@mark.parametrize(
    "changed",
    [
        {},
        replaced("run.json", b"05-31", b"06-01"),
        replaced("run.json", b"0.1", b"0.2"),
        replaced("run.json", b"masonry.formulas", b"masonry_x.a.b"),
        {"log.log": b"6 s", "report.html": b""},
        {"run.checkpoint": checkpoint(name="work")},
    ],
)
def test_dates_times_folders_and_names_may_differ(tmp_path, capsys, changed):
    assert compared(tmp_path, changed)
    assert capsys.readouterr().out.startswith("equal: made (4 files")


@mark.parametrize(
    "changed, shown",
    [
        (replaced("curve.csv", b"1.25", b"1.26"), "curve.csv: line 2: '0,1.25\\r' | '0,1.26\\r'"),
        (replaced("curve.csv", b"\r", b""), "curve.csv: line 1"),
        (replaced("run.json", b"1.25", b"1.250001"), "run.json: line 2"),
        (replaced("run.json", b'"steps": 5', b'"steps": 6'), "run.json: line 5"),
        (replaced("cracks.png", b"\xff", b"\xfe"), "cracks.png: line 1"),
        ({"run.checkpoint": checkpoint(force=np.nextafter(1.5, 2))}, "run.checkpoint: line 3"),
        ({"curve.csv": None}, "curve.csv: not of /two"),
        ({"blocks.pvd": b""}, "blocks.pvd: not of /one"),
    ],
)
def test_a_number_a_byte_or_a_file_may_not(tmp_path, capsys, changed, shown):
    assert not compared(tmp_path, changed)
    first, *others = capsys.readouterr().out.splitlines()
    assert first.startswith("differs: made") and len(others) == 1 and shown in others[0]


def test_work_that_fails_or_leaves_nothing_is_not_equal(tmp_path, capsys):
    def fails(attempt):
        attempt.run(sys.executable, "-c", "raise SystemExit('why')")

    assert not compare(Work("fails", fails), BUILDS, str(tmp_path))
    assert not compare(Work("nothing", str), BUILDS, str(tmp_path))
    message = capsys.readouterr().out
    assert re.search(r"failed: fails .*\n.*/one: exit status 1: \.\.\.why", message)
