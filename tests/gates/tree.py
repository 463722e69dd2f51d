# SPDX-License-Identifier: GPL-2.0-or-later
"""The files of the repository, and how a gate shows what it found."""

import os
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
CPP = (".cpp", ".hpp", ".inl")
SHELL = (".sh",)
#: How folders begin that git ignores.
LEFT_OUT = ("build", "results", "__pycache__", ".")


def files(endings, root=ROOT):
    """Paths of all files with these endings, from the root, in the order of their names.

    Inside a clone these are the files that git knows or would add, elsewhere all files.
    """
    command = ["git", "-C", root, "ls-files", "-co", "--exclude-standard", "-z"]
    listing = subprocess.run(command, capture_output=True, text=True)
    if listing.returncode == 0:
        found = set(listing.stdout.split("\0")) - {""}
    else:
        found = set()
        for folder, folders, names in os.walk(root):
            folders[:] = [f for f in folders if not f.startswith(LEFT_OUT)]
            found |= {os.path.relpath(os.path.join(folder, n), root) for n in names}
    wanted = [f for f in found if f.endswith(endings)]
    return sorted(f for f in wanted if os.path.isfile(os.path.join(root, f)))


def read(path, root=ROOT):
    with open(os.path.join(root, path), encoding="utf-8") as file:
        return file.read()
