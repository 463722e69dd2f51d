# SPDX-License-Identifier: GPL-2.0-or-later
"""The version stands in one place, and every file that names it names the same."""

import os
import re
import subprocess

import tree


def version():
    found = re.findall(
        r'^__version__ = "(.*)"$', tree.read("scripts/masonry/__init__.py"), re.M
    )
    assert len(found) == 1
    return found[0]


def test_the_version_has_three_numbers():
    assert re.fullmatch(r"\d+\.\d+\.\d+", version())


def test_the_first_entry_of_the_change_log_and_the_citation_are_of_this_version():
    first = re.search(r"^## (\S+)", tree.read("CHANGELOG.md"), re.M)
    assert first.group(1) == version()
    cited = re.search(r"^version: (\S+)$", tree.read("CITATION.cff"), re.M)
    assert cited.group(1) == version()


def test_the_debian_package_takes_the_version_from_the_same_line():
    """By the line of scripts/package.sh that reads it."""
    line = re.search(r"^number=\$\((.*)\)$", tree.read("scripts/package.sh"), re.M)
    run = subprocess.run(
        ["bash", "-c", line.group(1)],
        cwd=tree.ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stdout.strip() == version()


def test_no_other_file_of_the_build_writes_the_version_down():
    for path in ("CMakeLists.txt", "scripts/package.sh", "yade_plugin/module.cpp"):
        assert version() not in tree.read(path), path
    assert os.path.exists(os.path.join(tree.ROOT, "CMakeLists.txt"))
