# SPDX-License-Identifier: GPL-2.0-or-later
"""What the build makes: objects for one kind of vector units alone, and an installed package
without old modules."""

from usual import *
import glob

CORE = os.path.join(BUILD, "CMakeFiles", "masonry_core.dir")
FILES = glob.glob(CORE + "/**/CyclicOn*.cpp.o", recursive=True)


@mark.parametrize("file", FILES, ids=os.path.basename)
def test_a_file_for_vector_units_defines_its_own_function_alone(file):
    """A processor without these vector units would otherwise run instructions that it does not
    have."""
    lines = subprocess.check_output(["nm", "-C", "--defined-only", file], text=True)
    found = [line.split(maxsplit=2)[1:] for line in lines.splitlines()]
    shared = [words for kind, words in found if not kind.islower() or kind in "uvw"]
    name = os.path.basename(file).removeprefix("Cyclic").removesuffix(".cpp.o")
    names = [words.split("(")[0] for words in shared]
    assert names == [f"masonry::cyclic::advance{name}"]


def test_there_are_three_such_files():
    assert len(FILES) == 3


def test_an_installation_leaves_no_module_of_an_earlier_version(tmp_path):
    modulesIn = lambda at: {*glob.glob("**/*.py", root_dir=at, recursive=True)}
    environment = {**os.environ, "DESTDIR": str(tmp_path)}
    for _ in range(2):
        subprocess.run(["cmake", "--install", BUILD], check=True, env=environment)
        found = [p.parent for p in tmp_path.glob("**/masonry*/__init__.py")]
        assert len(found) == 5
        for package in found:
            assert modulesIn(package) == modulesIn(os.path.join(ROOT, "scripts", package.name))
            assert not (package / "gone").exists()  # its bytecode alone would be a package
            (package / "gone.py").write_text("")
            (package / "gone" / "__pycache__").mkdir(parents=True, exist_ok=True)
