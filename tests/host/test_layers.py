"""Who may know whom, by what the sources include."""

import glob
import os
import re

import pytest
from conftest import ROOT

PLUGIN = os.path.join(ROOT, "yade_plugin")
STANDARD = {"Eigen"}
ALSO = {"ConvexHull.cpp": {"CGAL"}}  # the one file that knows CGAL
MAY_INCLUDE = {
    "common": {"common"},
    "law": {"common", "law"},
    "blocks": {"common", "motion", "blocks"},
    "motion": {"common", "motion"},
    "files": {"common", "files"},
    "host": {"common", "host"},
    "scene": {"common", "law", "blocks", "motion", "files", "host", "scene", "adapters"},
    "adapters": {"common", "law", "blocks", "motion", "files", "host", "scene", "adapters"},
}


@pytest.mark.parametrize("layer", MAY_INCLUDE)
def test_a_layer_includes_only_what_it_may_know(layer):
    folder = os.path.join(PLUGIN, layer)
    files = glob.glob(os.path.join(folder, "**", "*.[chi][pn][pl]"), recursive=True)
    assert files
    for name in files:
        text = open(name).read()
        for included in re.findall(r'#include "([^"]+)"', text):
            owner = included.split("/")[0] if "/" in included else layer
            assert owner in MAY_INCLUDE[layer], f"{name} includes {included}"
        if layer not in ("host", "scene", "adapters"):
            for included in re.findall(r"#include <([^>]+)>", text):
                known = STANDARD | ALSO.get(os.path.basename(name), set())
                assert (
                    "/" not in included or included.split("/")[0] in known
                ), f"{name} includes {included}"


def test_host_classes_are_declared_in_one_file_only():
    for folder, _, names in os.walk(PLUGIN):
        for name in names:
            if os.path.basename(folder) != "host":
                assert "namespace yade {" not in open(os.path.join(folder, name)).read()
