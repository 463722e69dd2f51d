# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether the plugin fits a YADE, read from its package; nothing of it is run or installed.

    /usr/bin/python3 scripts/check_host.py libyade_VERSION_amd64.deb
    /usr/bin/python3 scripts/check_host.py FOLDER  # with the libraries of a YADE somewhere in it
    /usr/bin/python3 scripts/check_host.py FOLDER --show [CLASS...]  # prints its virtual functions
    /usr/bin/python3 scripts/check_host.py FOLDER --write VERSION _masonry.so  # writes its table

Compared are the virtual functions and the size of each class of Yade.hpp, and the functions that
the plugin calls, with the tables of the YADE versions that the plugin knows. Needs binutils, which
g++ brings. The exit status is 0 if the plugin fits, 1 if it does not, and 2 if the package cannot
be read.
"""

import functools
import pathlib
import re
import subprocess
import sys
import tempfile
from itertools import zip_longest

HOST = pathlib.Path(__file__).resolve().parents[1] / "yade_plugin" / "host"
TABLES = HOST / "tables"
WORD = 8  # [bytes]
UNREADABLE = 2  # exit status
HEAD = (
    2  # words before slot 0: the distance to the beginning of the object, and the type information
)
OPTIONAL = "Polyhedra"  # a YADE without CGAL does not have it
#: What makes names of functions long and says nothing here.
SHORTER = [
    (r", mpl_::na", ""),
    (r"\[abi:cxx11\]", ""),
    (
        r"std::__cxx11::basic_string<char, std::char_traits<char>, std::allocator<char> >",
        "std::string",
    ),
    (r"Eigen::Matrix<double, 3, 1, 0, 3, 1>", "Vector3r"),
    (r"\b(boost::python|boost::mpl|boost|yade|mpl_|api)::", ""),
]


class Unreadable(Exception):
    """What was given is no YADE that can be read."""


def output(*command, text=None):
    """What a program prints. Raises Unreadable."""
    try:
        done = subprocess.run(command, input=text, capture_output=True, text=True)
    except OSError as error:
        raise Unreadable(f"cannot run {command[0]}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise Unreadable(f"{command[-1]}: {command[0]} finds no text in it") from None
    if done.returncode:
        said = done.stderr.strip() or f"exit status {done.returncode}"
        raise Unreadable(f"{command[0]} cannot read it: {said}")
    return done.stdout


def declaredClasses():
    """Names of the classes that Yade.hpp and YadeGl.hpp declare."""
    headers = [(HOST / name).read_text("utf-8") for name in ("Yade.hpp", "YadeGl.hpp")]
    return re.findall(r"^class (\w+)[^;]*?\{", "\n".join(headers), re.MULTILINE)


class Library:
    """A shared library: its exported symbols, and what the loader writes into its tables."""

    def __init__(self, path):
        self.path = path
        self.symbols = {}  # name: (address, size)
        for line in output("nm", "-D", "-S", "--defined-only", path).splitlines():
            fields = line.split()
            name = fields[-1].split("@")[0]
            size = int(fields[1], 16) if len(fields) == 4 else 0
            self.symbols[name] = int(fields[0], 16), size

    @functools.cached_property
    def pointers(self):
        """Address of a word -> name of the symbol that the word will point to."""
        names = {address: name for name, (address, _) in self.symbols.items()}
        found, listed = {}, output("objdump", "-R", self.path)
        for address, target in re.findall(r"^([0-9a-f]{16}) +\S+ +(\S+)$", listed, re.M):
            local = re.fullmatch(r"\*ABS\*\+0x([0-9a-f]+)", target)
            target = names.get(int(local[1], 16), "") if local else target
            found[int(address, 16)] = target.split("@")[0]
        return found

    def tableOf(self, name):
        """Functions of a class in the order of its slots, without their classes; None if there is
        no table here."""
        address, size = self.symbols.get(f"_ZTVN4yade{len(name)}{name}E", (0, 0))
        if not size:
            return None
        slots = range(address + HEAD * WORD, address + size, WORD)
        words = [self.pointers.get(slot, "") for slot in slots]
        return [brief(word) for word in output("c++filt", text="\n".join(words)).split("\n")]

    def sizeOf(self, name):
        """Size [bytes] of the objects that YADE's own function makes; None if it is not here."""
        maker = f"_ZN4yade{len(name) + 6}Create{name}Ev"
        address, size = self.symbols.get(maker, (0, 0))
        if not size:
            return None
        span = f"--start-address={address}", f"--stop-address={address + size}"
        code = output("objdump", "-d", "--no-show-raw-insn", *span, self.path)
        found = re.search(r"\$0x([0-9a-f]+),%edi.*?<_Znwm", code, re.DOTALL)
        return int(found[1], 16) if found else None


def brief(function):
    """The name of a function with its arguments, without its class: a class may override what its
    base has."""
    for long, short in SHORTER:
        function = re.sub(long, short, function)
    function = re.sub(r".*::(?=[~\w]+\()", "", function)
    if function.startswith("~"):
        return "~"
    return re.sub("^typeinfo.*", "(type)", function) or "(distance)"


class Yade:
    """What the plugin needs to know of a YADE: classes {name: (size, functions)} and names of
    functions it calls."""

    def __init__(self, version, classes, calls):
        self.version, self.classes, self.calls = version, classes, calls

    @classmethod
    def ofFolder(cls, folder, version):
        # Of the builds in a package the plain one, whose numbers are double.
        core = sorted(
            pathlib.Path(folder).rglob("libyade.so"),
            key=lambda p: (p.parent.name != "yade-double", p),
        )
        if not core:
            raise Unreadable(f"{folder}: no libyade.so in it")
        paths = sorted(core[0].parent.glob("lib*.so"), key=lambda p: p.name != "libyade.so")
        libraries = [Library(str(path)) for path in paths]
        classes = {}
        for name in declaredClasses():
            table = next(filter(None, (one.tableOf(name) for one in libraries)), None)
            size = next(filter(None, (one.sizeOf(name) for one in libraries)), None)
            if table:
                classes[name] = size, table
        if not classes:
            raise Unreadable(f"{core[0]}: no class of YADE in it")
        symbols = set().union(*(library.symbols for library in libraries))
        return cls(version, classes, symbols)

    @classmethod
    def ofTable(cls, path):
        classes, calls, table = {}, set(), []
        for line in path.read_text("utf-8").splitlines():
            if line.startswith("  "):
                table.append(line.strip())
            elif line.startswith("_Z"):
                calls.add(line)
            elif line:
                name, size, base = line.split()
                table = list(classes[base][1]) if base in classes else []
                classes[name] = int(size) if size.isdigit() else None, table
        return cls(path.stem, classes, calls)

    def write(self, module):
        """A class is written from where its functions are others than those of the class that it
        begins as."""
        lines, written = [], {}
        for name, (size, table) in self.classes.items():
            like = [w for w, t in written.items() if table[: len(t)] == t]
            base = max(like, key=lambda w: len(written[w]), default="-")
            lines += [f"{name} {size or '-'} {base}"]
            lines += ["  " + slot for slot in table[len(written.get(base, [])) :]]
            written[name] = table
        lines += [""] + sorted(callsOf(module, self.classes) & self.calls)
        path = TABLES / f"{self.version}.txt"
        path.write_text("\n".join(lines) + "\n", "utf-8")

    def differences(self, known):
        """What is other in this YADE than in a known one, a line each."""
        for name, (size, functions) in known.classes.items():
            if name not in self.classes:
                if name != OPTIONAL:
                    yield f"{name}: not in this YADE"
                continue
            mySize, mine = self.classes[name]
            if mySize != size:
                yield f"{name}: {size} bytes in {known.version}, {mySize} in this YADE"
            slots = enumerate(zip_longest(functions, mine, fillvalue="nothing"))
            other = ((slot, *pair) for slot, pair in slots if pair[0] != pair[1])
            for slot, theirs, own in list(other)[:1]:
                yield (
                    f"{name}, virtual function {slot} of {len(mine)}: {theirs} in {known.version},"
                    f" {own} in this YADE"
                )
        for call in sorted(known.calls - self.calls):
            yield f"not in this YADE: {output('c++filt', call).strip()}"


def callsOf(module, classes):
    """Functions of YADE that a built module calls by name: neither virtual ones nor those that save
    objects."""
    wanted = output("nm", "-D", "--undefined-only", module).split()
    mine = [s for s in wanted if "4yade" in s and not re.match("_ZT|.*archive", s)]
    named = output("c++filt", text="\n".join(mine)).split("\n")
    virtual = {f for _, functions in classes.values() for f in functions}
    return {call for call, name in zip(mine, named) if brief(name) not in virtual}


def knownYades():
    return map(Yade.ofTable, sorted(TABLES.glob("*.txt")))


def read(package):
    """The YADE in a package or in a folder."""
    if not package.endswith(".deb"):
        return Yade.ofFolder(package, "this YADE")
    with tempfile.TemporaryDirectory() as folder:
        output("dpkg-deb", "-x", package, folder)
        return Yade.ofFolder(folder, output("dpkg-deb", "-f", package, "Version").strip())


def report(yade):
    """Says which known YADE this one is like; whether there is one."""
    found = {known.version: list(yade.differences(known)) for known in knownYades()}
    nearest = min(reversed(found), key=lambda version: len(found[version]))
    fits = [version for version, wrong in found.items() if not wrong]
    absent = "" if OPTIONAL in yade.classes else f", without {OPTIONAL}"
    slots = sum(len(functions) for _, functions in yade.classes.values())
    print(f"{yade.version}: {len(yade.classes)} classes, {slots} virtual functions{absent}")
    if fits:
        print(f"fits: as {' and '.join(fits)}")
    else:
        print(f"does not fit; nearest is {nearest}:\n  " + "\n  ".join(found[nearest]))
    return bool(fits)


def main(package, *options):
    yade = read(package)
    if options[:1] == ("--show",):
        for name in options[1:] or yade.classes:
            size, functions = yade.classes[name]
            print(f"{name}, {size} bytes, {len(functions)} virtual functions")
            for slot, function in enumerate(functions):
                print(f"{slot:6d}  {function}")
    elif options[:1] == ("--write",):
        yade.version = options[1]
        yade.write(options[2])
    else:
        sys.exit(not report(yade))


if __name__ == "__main__":
    if len(sys.argv) < 2 or not pathlib.Path(sys.argv[1]).exists():
        print(__doc__, file=sys.stderr)
        sys.exit(UNREADABLE)
    try:
        main(*sys.argv[1:])
    except Unreadable as error:
        print(f"{sys.argv[1]}: {error}", file=sys.stderr)
        sys.exit(UNREADABLE)
