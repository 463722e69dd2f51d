# SPDX-License-Identifier: GPL-2.0-or-later
"""What the build makes: objects for one kind of vector units alone, and an installed package without old modules."""

from usual import *
import glob
import pathlib

FILES = glob.glob(
    os.path.join(BUILD, "CMakeFiles", "masonry_core.dir", "**", "CyclicOn*.cpp.o"),
    recursive=True,
)


@pytest.mark.parametrize("file", FILES, ids=os.path.basename)
def test_a_file_for_vector_units_defines_its_own_function_alone(file):
    """A processor without these vector units would otherwise run instructions that it does not have."""
    lines = subprocess.run(
        ["nm", "--demangle", "--defined-only", file],
        capture_output=True,
        text=True,
        check=True,
    )
    found = [line.split(maxsplit=2)[1:] for line in lines.stdout.splitlines()]
    shared = [words for kind, words in found if not kind.islower() or kind in "uvw"]
    name = os.path.basename(file).removeprefix("Cyclic").removesuffix(".cpp.o")
    assert [words.split("(")[0] for words in shared] == [
        f"masonry::cyclic::advance{name}"
    ]


def test_there_are_three_such_files():
    assert len(FILES) == 3


def test_an_installation_leaves_no_module_of_an_earlier_version(tmp_path):
    install = ["cmake", "--install", BUILD]
    environment = {**os.environ, "DESTDIR": str(tmp_path)}
    for _ in range(2):
        subprocess.run(install, check=True, capture_output=True, env=environment)
        (package,) = tmp_path.glob("**/masonry/__init__.py")
        modules = sorted(
            p.relative_to(package.parent) for p in package.parent.rglob("*.py")
        )
        source = os.path.join(ROOT, "scripts", "masonry")
        assert modules == sorted(
            p.relative_to(source) for p in pathlib.Path(source).rglob("*.py")
        )
        (package.parent / "gone.py").write_text("")
        (package.parent / "study" / "gone.py").write_text("")
