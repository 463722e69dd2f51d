# SPDX-License-Identifier: GPL-2.0-or-later
"""The line that names the licence, in each source file among its first three lines."""

import re

import tree

LICENCE = "SPDX-License-Identifier: GPL-2.0-or-later"
ENDINGS = tree.CPP + tree.SHELL + (".py", ".js", ".css", "CMakeLists.txt", ".ci/run")


def isMissing(path, root=tree.ROOT):
    first = tree.read(path, root).splitlines()[:3]
    return not any(re.fullmatch(rf"(#|//) {LICENCE}|/\* {LICENCE} \*/", line) for line in first)


def missing():
    return [path for path in tree.files(ENDINGS) if isMissing(path)]
