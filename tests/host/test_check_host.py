# SPDX-License-Identifier: GPL-2.0-or-later
"""What scripts/check_host.py says of a YADE that it reads and does not run."""

import copy
import glob
import importlib.util

import yade.config
import yade.wrapper
from usual import *

PATH = os.path.join(ROOT, "scripts", "check_host.py")
spec = importlib.util.spec_from_file_location("check_host", PATH)
host = importlib.util.module_from_spec(spec)
spec.loader.exec_module(host)
KNOWN = {known.version: known for known in host.knownYades()}


@mark.slow
def test_the_yade_that_is_installed_fits_as_its_own_version(capsys):
    folder = os.path.dirname(glob.glob("/usr/lib/*/yade-double/libyade.so")[0])
    with raises(SystemExit) as end:
        host.main(folder)
    said = capsys.readouterr().out
    assert end.value.code == 0 and f"fits: as {yade.config.version}" in said, said


@mark.parametrize("name", ["libyade.deb", "folder", "damaged"])
def test_what_cannot_be_read_has_a_status_of_its_own(tmp_path, name):
    (tmp_path / "libyade.deb").write_bytes(b"!<arch>\ndebian-binary   \xff")
    (tmp_path / "folder").mkdir()
    (tmp_path / "damaged").mkdir()
    (tmp_path / "damaged" / "libyade.so").write_bytes(b"\x7fELF\x02\x01\x01" + 40 * b"\xfe")
    command = [sys.executable, PATH, str(tmp_path / name)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2 and "Traceback" not in done.stderr
    assert done.stderr.startswith(str(tmp_path / name)) and done.stdout == ""


def test_three_releases_differ_in_what_is_known_of_them():
    """The function more in the shapes of 2026.1.0, two members of its integrator, and no Polyhedra
    without CGAL."""
    first, second, third = (KNOWN[v] for v in ("2023.02a", "2025.2.0", "2026.1.0"))
    assert "Polyhedra" in first.classes and "Polyhedra" not in second.classes
    assert list(second.differences(first)) == [
        "NewtonIntegrator: 432 bytes in 2023.02a, 440 in this YADE",
        "not in this YADE: yade::Polyhedra::GetSurfaceTriangulation()",
    ]
    assert list(third.differences(second)) == [
        "Shape, virtual function 12 of 27: modifyClassIndex() in 2025.2.0, getVolume() in this YADE"
    ]


@mark.parametrize("version", KNOWN)
def test_each_fault_in_each_class_is_shown_with_its_name(version):
    known = KNOWN[version]
    assert list(known.differences(known)) == []

    def difference(change):
        other = copy.deepcopy(known)
        change(other)
        (line,) = other.differences(known)
        return line

    for name, (size, functions) in known.classes.items():
        slot, last = name + ", virtual function ", len(functions) - 1
        table = lambda other: other.classes[name][1]
        for at in range(len(functions)):
            more = difference(lambda other: table(other).insert(at, "stranger()"))
            assert more.startswith(f"{slot}{at} of ")
        fewer = difference(lambda other: table(other).pop())
        assert fewer.startswith(f"{slot}{last} of {last}: ")
        if functions[last] != functions[last - 1]:
            swap = lambda other: table(other).insert(last - 1, table(other).pop())
            assert difference(swap).startswith(f"{slot}{last - 1} of")
        grown = {name: ((size or 0) + 8, functions)}
        grows = difference(lambda other: other.classes.update(grown))
        assert grows.startswith(f"{name}: {size} bytes in")
        if name != host.OPTIONAL:
            gone = difference(lambda other: other.classes.pop(name))
            assert gone == f"{name}: not in this YADE"
    for call in known.calls:
        gone = difference(lambda other: other.calls.remove(call))
        assert "not in this YADE: " in gone


def test_the_tables_name_all_that_the_module_calls():
    """Whoever adds a call writes the tables anew, or a YADE without that function would be called
    fitting."""
    module = os.path.join(
        *importlib.util.find_spec("masonry").submodule_search_locations, "_masonry.so"
    )
    known = KNOWN[yade.config.version]
    calls = host.callsOf(module, known.classes) - known.calls
    assert {
        c for c in calls if host.OPTIONAL not in c or hasattr(yade.wrapper, host.OPTIONAL)
    } == set()
