# SPDX-License-Identifier: GPL-2.0-or-later
"""What scripts/check_host.py says of a YADE that it reads and does not run."""

import copy
import glob
import importlib.util
import os

import pytest
import yade.config
import yade.wrapper
from conftest import ROOT

spec = importlib.util.spec_from_file_location(
    "check_host", os.path.join(ROOT, "scripts", "check_host.py")
)
host = importlib.util.module_from_spec(spec)
spec.loader.exec_module(host)
KNOWN = {known.version: known for known in host.knownYades()}


@pytest.mark.slow
def test_the_yade_that_is_installed_fits_as_its_own_version(capsys):
    folder = os.path.dirname(glob.glob("/usr/lib/*/yade-double/libyade.so")[0])
    with pytest.raises(SystemExit) as end:
        host.main(folder)
    said = capsys.readouterr().out
    assert end.value.code == 0 and f"fits: as {yade.config.version}" in said, said


def test_three_releases_differ_in_what_is_known_of_them():
    """The function more in the shapes of 2026.1.0, two members of its integrator, and no Polyhedra without CGAL."""
    first, second, third = (KNOWN[v] for v in ("2023.02a", "2025.2.0", "2026.1.0"))
    assert "Polyhedra" in first.classes and "Polyhedra" not in second.classes
    assert list(second.differences(first)) == [
        "NewtonIntegrator: 432 bytes in 2023.02a, 440 in this YADE",
        "not in this YADE: yade::Polyhedra::GetSurfaceTriangulation()",
    ]
    assert list(third.differences(second)) == [
        "Shape, virtual function 12 of 27: modifyClassIndex() in 2025.2.0, getVolume() in this YADE"
    ]


@pytest.mark.parametrize("version", KNOWN)
def test_each_fault_in_each_class_is_shown_with_its_name(version):
    known = KNOWN[version]
    assert list(known.differences(known)) == []

    def difference(change):
        other = copy.deepcopy(known)
        change(other)
        (line,) = other.differences(known)
        return line

    for name, (size, functions) in known.classes.items():
        for at in range(len(functions)):
            slot = f"{name}, virtual function {at} of "

            def more(other):
                other.classes[name][1].insert(at, "stranger()")

            assert difference(more).startswith(slot), slot
        last = len(functions) - 1

        def fewer(other):
            other.classes[name][1].pop()

        def exchanged(other):
            table = other.classes[name][1]
            table[last], table[last - 1] = table[last - 1], table[last]

        def grown(other):
            other.classes[name] = (size or 0) + 8, functions

        def gone(other):
            del other.classes[name]

        assert difference(fewer).startswith(
            f"{name}, virtual function {last} of {last}: "
        )
        if functions[last] != functions[last - 1]:
            assert difference(exchanged).startswith(
                f"{name}, virtual function {last - 1} of"
            )
        assert difference(grown).startswith(f"{name}: {size} bytes in")
        if name != host.OPTIONAL:
            assert difference(gone) == f"{name}: not in this YADE"
    for call in known.calls:
        assert "not in this YADE: " in difference(
            lambda other: other.calls.remove(call)
        )


def test_the_tables_name_all_that_the_module_calls():
    """Whoever adds a call writes the tables anew, or a YADE without that function would be called fitting."""
    module = os.path.join(*importlib.util.find_spec("masonry").submodule_search_locations, "_masonry.so")  # fmt: skip
    known = KNOWN[yade.config.version]
    calls = host.callsOf(module, known.classes) - known.calls
    assert {c for c in calls if host.OPTIONAL not in c or hasattr(yade.wrapper, host.OPTIONAL)} == set()  # fmt: skip
