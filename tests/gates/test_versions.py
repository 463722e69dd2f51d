# SPDX-License-Identifier: GPL-2.0-or-later
"""The version stands in one place, and every file that names it names the same."""

import os
import re
import subprocess
from email.utils import parsedate_to_datetime

import tree


def version():
    source = tree.read("scripts/masonry/__init__.py")
    (found,) = re.findall(r'^__version__ = "(.*)"$', source, re.M)
    return found


def test_change_log_and_citation_are_of_this_version_of_three_numbers():
    assert re.fullmatch(r"\d+\.\d+\.\d+", version())
    for path, line in (
        ("CHANGELOG.md", r"^## (\S+)"),
        ("CITATION.cff", r"^version: (\S+)$"),
        ("scripts/debian/changelog", r"^yade-masonry \((\S+)\+ds-\d+\)"),
    ):
        assert re.search(line, tree.read(path), re.M)[1] == version(), path


def test_the_release_has_one_date():
    (day,) = re.findall(r"^## \S+ \((\S+)\)\n\n\*\*From", tree.read("CHANGELOG.md"), re.M)
    assert f"\ndate-released: {day}\n" in tree.read("CITATION.cff")
    package = re.search(r"^ -- \S+  (.*)$", tree.read("scripts/debian/changelog"), re.M)[1]
    assert parsedate_to_datetime(package).date().isoformat() == day


def test_the_debian_package_takes_the_version_from_the_same_line():
    line = re.search(r"^ *number=\$\((.*)\)$", tree.read("scripts/package.sh"), re.M)
    command = ["bash", "-c", line.group(1)]
    said = subprocess.check_output(command, cwd=tree.ROOT, text=True)
    assert said.strip() == version()


def test_no_other_file_of_the_build_writes_the_version_down():
    for path in ("CMakeLists.txt", "scripts/package.sh", "yade_plugin/module.cpp"):
        assert version() not in tree.read(path), path
    assert os.path.exists(os.path.join(tree.ROOT, "CMakeLists.txt"))
