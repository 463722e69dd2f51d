# SPDX-License-Identifier: GPL-2.0-or-later
"""Who may know whom, by what the sources include. These tests need no YADE: they only read the sources."""

import glob
from usual import *

PLUGIN = os.path.join(os.path.dirname(__file__), "..", "..", "yade_plugin")
STANDARD = {"Eigen"}
ALSO = {"ConvexHull.cpp": {"CGAL"}}  # the one file that knows CGAL
BELOW_SCENE = {"common", "law", "blocks", "motion", "contact", "files", "host"}
MAY_INCLUDE = {
    "common": {"common"},
    "law": {"common", "law"},
    "blocks": {"common", "motion", "blocks"},
    "motion": {"common", "motion"},
    "contact": {"common", "blocks", "contact"},
    "files": {"common", "files"},
    "host": {"common", "host"},
    "scene": BELOW_SCENE | {"scene"},
    "adapters": BELOW_SCENE | {"scene", "adapters"},
}
WITH_YADE = ("host", "scene", "adapters")
FOLDERS = ("bodies", "joints", "contacts", "store", "checks")  # of scene

#: What registered classes share, so it is in adapters/ without being one.
SHARED = {
    f"{name}.hpp"
    for name in "Adapter Assumptions Attribute Colours FunctorOfLaw".split()
}


def sources(folder):
    return glob.glob(os.path.join(folder, "**", "*.[chi][pn][pl]"), recursive=True)


def included(name):
    return re.findall(r'#include "([^"]+)"', open(name).read())


@pytest.mark.parametrize("layer", MAY_INCLUDE)
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


def test_a_folder_of_the_scene_includes_only_those_before_it():
    folder = os.path.join(PLUGIN, "scene")
    assert sorted(os.listdir(folder)) == sorted(FOLDERS)
    for n, name in enumerate(FOLDERS):
        for source in sources(os.path.join(folder, name)):
            for path in included(source):
                layer, _, rest = path.partition("/")
                known = layer != "scene" or rest.split("/")[0] in FOLDERS[:n]
                assert known, f"{source} includes {path}"


def circles(folder):
    """Include circles among the pairs of files under a folder; a .hpp with its .cpp and .inl counts as one file.

    :returns: a sorted list of names for every circle: pairs that include each other, directly or through others
    """
    knows = {}
    for name in sources(folder):
        pair = os.path.relpath(os.path.splitext(name)[0], folder)
        knows.setdefault(pair, set())
        for path in included(name):
            beside = os.path.join(os.path.dirname(name), path)
            start = os.path.dirname(name) if os.path.exists(beside) else folder
            there = os.path.join(start, os.path.splitext(path)[0])
            other = os.path.relpath(there, folder)
            if other != pair:
                knows[pair].add(other)

    def reached(pair):
        found, left = set(), list(knows.get(pair, ()))
        while left:
            other = left.pop()
            if other not in found:
                found.add(other)
                left.extend(knows.get(other, ()))
        return found

    reach = {pair: reached(pair) for pair in knows}
    within = [pair for pair in knows if pair in reach[pair]]
    circle = lambda pair: sorted(o for o in reach[pair] if pair in reach[o])
    return sorted({tuple(circle(pair)) for pair in within})


@pytest.mark.parametrize("layer", MAY_INCLUDE)
def test_no_files_include_each_other_in_a_circle(layer):
    inLayer = [c for c in circles(PLUGIN) if c[0].split(os.sep)[0] == layer]
    assert inLayer == []


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
    assert circles(tmp_path) == [("one/A", "one/B", "two/C")]
    (tmp_path / "one/B.hpp").write_text("")
    assert circles(tmp_path) == []


def test_every_file_of_adapters_holds_one_class_that_yade_sees():
    for name in glob.glob(os.path.join(PLUGIN, "adapters", "*.hpp")):
        if os.path.basename(name) not in SHARED:
            key = r"BOOST_CLASS_EXPORT_KEY\(masonry::(\w+)\)"
            keys = re.findall(key, open(name).read())
            assert keys == [os.path.basename(name)[: -len(".hpp")]], name


def test_host_classes_are_declared_in_one_file_only():
    for folder, _, names in os.walk(PLUGIN):
        for name in names:
            if os.path.basename(folder) != "host":
                assert "namespace yade {" not in open(os.path.join(folder, name)).read()
