# SPDX-License-Identifier: GPL-2.0-or-later
"""Virtual function tables of YADE's classes, read from a shared library; nothing of the library is run.

    /usr/bin/python3 yade_plugin/host/vtable.py LIBRARY [CLASS...]

Without names: the classes that Yade.hpp declares and the library holds. Slots are counted as SelfCheck.cpp counts them:
slot 0 is where an object's table pointer points to. A class with a second base has a second table behind the first
one; it begins with two words that are no functions, and its functions are thunks that shift the object's address.
"""

import os
import re
import subprocess
import sys

WORD = 8  # [bytes]
HEAD = 2  # words before slot 0: the distance to the beginning of the object, and the type information


def output(*command, text=None):
    return subprocess.run(
        command, input=text, capture_output=True, text=True, check=True
    ).stdout


def symbolsOf(library):
    """Exported symbols: name -> (address, size)."""
    symbols = {}
    for line in output("nm", "-D", "-S", "--defined-only", library).splitlines():
        fields = line.split()
        if len(fields) == 4:
            address, size, _, name = fields
            symbols[name.split("@")[0]] = int(address, 16), int(size, 16)
    return symbols


def pointersOf(library, symbols):
    """What the loader writes into the library: address of a word -> name of the symbol that the word will point to."""
    names = {address: name for name, (address, _) in symbols.items()}
    pointers = {}
    for line in output("objdump", "-R", library).splitlines():
        fields = line.split()
        if len(fields) != 3 or not re.fullmatch("[0-9a-f]{16}", fields[0]):
            continue
        target = fields[2]
        local = re.fullmatch(r"\*ABS\*\+0x([0-9a-f]+)", target)
        if local:
            target = names.get(int(local[1], 16), "a function that is not exported")
        pointers[int(fields[0], 16)] = target.split("@")[0]
    return pointers


def tableOf(name, symbols, pointers):
    """Demangled names of all words of the table of a class; empty if the library does not hold it."""
    address, size = symbols.get(f"_ZTVN4yade{len(name)}{name}E", (0, 0))
    words = [pointers.get(address + at, "") for at in range(0, size, WORD)]
    readable = output("c++filt", text="\n".join(words)).split("\n") if words else []
    return [word or "(distance to the object)" for word in readable[: len(words)]]


def declaredClasses():
    """Names of the classes that Yade.hpp and YadeGl.hpp declare."""
    names = []
    for header in ("Yade.hpp", "YadeGl.hpp"):
        path = os.path.join(os.path.dirname(os.path.abspath(__file__)), header)
        with open(path, encoding="utf-8") as f:
            names += re.findall(r"^class (\w+)[^;]*\{", f.read(), re.MULTILINE)
    return names


if len(sys.argv) < 2:
    sys.exit(__doc__)
library, asked = sys.argv[1], sys.argv[2:]
symbols = symbolsOf(library)
pointers = pointersOf(library, symbols)
for name in asked or declaredClasses():
    words = tableOf(name, symbols, pointers)
    if words:
        print(f"{name}, {len(words) - HEAD} slots")
    elif asked:
        print(f"{name}: no table in this library")
    for slot, word in enumerate(words, start=-HEAD):
        print(f"{slot:6d}  {word}")
