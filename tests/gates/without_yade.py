# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs pytest as on a machine without YADE: ``/usr/bin/python3 tests/gates/without_yade.py
[arguments of pytest]``.

Whatever imports YADE fails. Without arguments these are the rings and files that need no YADE.
"""

import os
import sys

import pytest

TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


class NoYade:
    """Stands before all other finders of modules."""

    @staticmethod
    def find_spec(name, path=None, target=None):
        if name.split(".")[0] == "yade":
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)


def main(arguments):
    sys.meta_path.insert(0, NoYade)
    sys.path.insert(0, TESTS)
    import conftest

    every = [os.path.join(TESTS, name) for name in conftest.WITHOUT_YADE]
    return pytest.main(["-q", "-p", "no:cacheprovider", *(arguments or every)])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
