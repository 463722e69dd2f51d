"""Files that are compiled for one kind of vector units give the linker nothing that other files may take from them."""

import glob
import os
import subprocess

import pytest
from conftest import BUILD

FILES = glob.glob(os.path.join(BUILD, "**", "CyclicOn*.cpp.o"), recursive=True)


@pytest.mark.parametrize("name", sorted({os.path.basename(file) for file in FILES}))
def test_a_file_for_vector_units_defines_its_own_function_alone(name):
    """A processor without these vector units would otherwise run instructions that it does not have."""
    for file in FILES:
        if os.path.basename(file) != name:
            continue
        lines = subprocess.run(["nm", "--demangle", "--defined-only", file], capture_output=True, text=True, check=True)
        found = [line.split(maxsplit=2)[1:] for line in lines.stdout.splitlines()]
        shared = [words for kind, words in found if not kind.islower() or kind in "uvw"]
        function = "masonry::cyclic::advance" + name[len("Cyclic") : -len(".cpp.o")]
        assert [words.split("(")[0] for words in shared] == [function]


def test_there_are_three_such_files():
    assert len({os.path.basename(file) for file in FILES}) == 3
