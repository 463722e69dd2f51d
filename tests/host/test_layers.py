# SPDX-License-Identifier: GPL-2.0-or-later
"""Who may know whom, by what the sources include. These tests need no YADE: they only read the
sources."""

import glob
import graphlib
from usual import *

PLUGIN = os.path.join(ROOT, "yade_plugin")
STANDARD = {"Eigen"}
ALSO = {"ConvexHull.cpp": {"CGAL"}}  # the one file that knows CGAL
BELOW_ENGINE = {"common", "law", "blocks", "motion", "contact", "files", "host"}
MAY_INCLUDE = {
    "common": {"common"},
    "law": {"common", "law"},
    "blocks": {"common", "motion", "blocks"},
    "motion": {"common", "motion"},
    "contact": {"common", "blocks", "contact"},
    "files": {"common", "files"},
    "host": {"common", "host"},
    "engine": BELOW_ENGINE | {"engine"},
    "adapters": BELOW_ENGINE | {"engine", "adapters"},
}
WITH_YADE = ("host", "engine", "adapters")
ROOMS = "bodies units joints connectors contacts store watch checkpoint".split()  # of engine

#: What registered classes share, so it is in adapters/ without being one.
SHARED = "Adapter Assumptions Attribute Colours Connecting EngineAdapter FunctorOfLaw".split()


def sources(folder):
    return glob.glob(os.path.join(folder, "**", "*.[chi][pn][pl]"), recursive=True)


def included(name):
    return re.findall(r'#include "([^"]+)"', open(name).read())


@mark.parametrize("layer", MAY_INCLUDE)
def test_a_layer_includes_only_what_it_may_know(layer):
    files = sources(os.path.join(PLUGIN, layer))
    assert files
    for name in files:
        for path in included(name):
            owner = path.split("/")[0] if "/" in path else layer
            assert owner in MAY_INCLUDE[layer], f"{name} includes {path}"
        if layer not in WITH_YADE:
            for path in re.findall(r"#include <([^>]+)>", open(name).read()):
                known = STANDARD | ALSO.get(os.path.basename(name), set())
                first = path.partition("/")
                assert not first[1] or first[0] in known, f"{name} includes {path}"


def test_a_room_of_the_engine_includes_only_those_before_it():
    folder = os.path.join(PLUGIN, "engine")
    assert sorted(os.listdir(folder)) == sorted(ROOMS)
    for n, name in enumerate(ROOMS):
        for source in sources(os.path.join(folder, name)):
            for path in included(source):
                layer, _, rest = path.partition("/")
                known = layer != "engine" or rest.split("/")[0] in ROOMS[:n]
                assert known, f"{source} includes {path}"


def test_nothing_in_engine_names_a_class_of_adapters():
    names = [
        os.path.basename(path)[:-4] for path in glob.glob(os.path.join(PLUGIN, "adapters", "*.hpp"))
    ]
    word = re.compile(r"\b(%s)\b" % "|".join(set(names) - set(SHARED)))
    for path in sources(os.path.join(PLUGIN, "engine")):
        assert not word.findall(open(path).read()), path


def circle(folder):
    """Files below a folder that include each other, directly or through others, or None; a .hpp,
    its .cpp and its .inl are one."""
    knows = {}
    for name in sources(folder):
        own = os.path.relpath(os.path.splitext(name)[0], folder)
        for path in included(name):
            beside = os.path.join(os.path.dirname(name), path)
            start = os.path.dirname(name) if os.path.exists(beside) else folder
            there = os.path.join(start, os.path.splitext(path)[0])
            knows.setdefault(own, set()).add(os.path.relpath(there, folder))
    others = {own: known - {own} for own, known in knows.items()}
    try:
        graphlib.TopologicalSorter(others).prepare()
    except graphlib.CycleError as error:
        return set(error.args[1])


def test_no_files_include_each_other_in_a_circle():
    assert circle(PLUGIN) is None


def test_a_circle_through_the_source_of_a_header_is_seen(tmp_path):
    texts = {
        "one/A.hpp": "",
        "one/A.cpp": '#include "A.hpp"\n#include "B.hpp"\n',
        "one/B.hpp": '#include "two/C.hpp"\n',
        "two/C.hpp": "",
        "two/C.inl": '#include "one/A.hpp"\n',
        "two/D.cpp": '#include "C.hpp"\n',
    }
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    assert circle(tmp_path) == {"one/A", "one/B", "two/C"}
    (tmp_path / "one/B.hpp").write_text("")
    assert circle(tmp_path) is None


def test_every_file_of_adapters_holds_one_class_that_yade_sees():
    for path in glob.glob(os.path.join(PLUGIN, "adapters", "*.hpp")):
        name = os.path.basename(path).removesuffix(".hpp")
        if name not in SHARED:
            key = r"(?:MASONRY_DECLARE\(|EXPORT_KEY\(masonry::)(\w+)\)"
            assert re.findall(key, open(path).read()) == [name]


def test_host_classes_are_declared_in_one_file_only():
    for path in sources(PLUGIN):
        if os.path.basename(os.path.dirname(path)) != "host":
            assert "namespace yade {" not in open(path).read(), path
