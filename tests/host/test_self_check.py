# SPDX-License-Identifier: GPL-2.0-or-later
"""The self-check of the plugin: what it refuses, what it leaves alone, and what the module shows to
others."""

import importlib.util
from usual import *

HOST = os.path.join(ROOT, "yade_plugin", "host")
PACKAGE = importlib.util.find_spec("masonry").submodule_search_locations
MODULE = os.path.join(*PACKAGE, "_masonry.so")
FIND = "import sys; sys.path.insert(1, '/usr/lib/x86_64-linux-gnu/yade-double/py')\nimport yade\n"


def run(*command):
    return ran(command)


def inFreshYade(code):
    return run(sys.executable, "-c", FIND + code)


def source(name):
    with open(os.path.join(HOST, name), encoding="utf-8") as file:
        return file.read()


CHECK = source("SelfCheck.cpp")
TABLES = re.findall(r"\bX\((\w+)\)", CHECK)
MEMBERS = re.findall(r"^ +AT\((\w+), (\w+)\)", CHECK, re.MULTILINE) + [("State", "se3")]
SIZES = re.findall(r'{"(\w+)", sizeof\(\w+\), "(\w+)", "(\w+)"}', CHECK)

#: Changes the tables of the running YADE in its memory, tries to import the module, and changes
#: them back.
FAULTS = """
from yade import *
import ctypes, importlib.util, yade.wrapper
O.bodies.append(Body())
before, scenes = O.engines, O.thisScene
spec = importlib.util.spec_from_file_location("_masonry", MODULE)
libraries = ctypes.CDLL(None)

def differences():
    try:
        importlib.util.module_from_spec(spec)
    except ImportError as error:
        assert "knows YADE 2023.02a" in str(error) and "nothing was registered" in str(error)
        return [line for line in str(error).splitlines() if line.startswith("  ")]
    return []

def words(address, count):
    page = address & ~4095
    size = address + 8 * count - page
    assert not libraries.mprotect(ctypes.c_void_p(page), ctypes.c_size_t(size), 3)
    return (ctypes.c_int64 * count).from_address(address)

def changed(memory, values, expected):
    kept = memory[:]
    memory[:] = values
    found = differences()
    memory[:] = kept
    assert len(found) == 1 and found[0].strip().startswith(expected), (expected, found)

class Info(ctypes.Structure):
    _fields_ = [
        ("path", ctypes.c_char_p), ("base", ctypes.c_void_p),
        ("name", ctypes.c_char_p), ("at", ctypes.c_void_p),
    ]

def table(name):
    # Its words and the one behind it, and the number in the list of symbols that is its size.
    address = ctypes.addressof(ctypes.c_byte.in_dll(libraries, f"_ZTVN4yade{len(name)}{name}E"))
    info, entry = Info(), ctypes.c_void_p()
    assert libraries.dladdr1(ctypes.c_void_p(address), ctypes.byref(info), ctypes.byref(entry), 1)
    size = words(entry.value + 16, 1)
    return words(address, size[0] // 8 + 1), size

def offset(cls, member):
    getter = vars(getattr(yade.wrapper, cls))[member].fget
    caller = ctypes.c_void_p.from_address(id(getter) + 16).value
    return words(caller + 8, 1)

stranger = ctypes.addressof(ctypes.c_byte.in_dll(libraries, "_ZN4yade14ForceContainer4syncEv"))
for name in TABLES:
    memory, size = table(name)
    count, whole = size[0] // 8, memory[:]
    for at in 4, count - 2:  # the first function that is no destructor, and the last but one
        said = f"{name}, virtual function {at - 2} of {count - 2}"
        changed(memory, whole[:at] + [whole[at + 1], whole[at]] + whole[at + 2 :], said)
        size[0] += 8
        said = f"{name}, virtual function {at - 2} of {count - 1}"
        changed(memory, whole[:at] + [stranger] + whole[at:-2] + whole[-1:], said + ": expected")
        size[0] -= 16
        said = f"{name}, virtual function {at - 2} of {count - 3}"
        changed(memory, whole[:at] + whole[at + 1 : -1] + [0] + whole[-1:], said)
        size[0] += 8
    changed(memory, [*whole[:2], whole[3], whole[2], *whole[4:]], f"{name}, virtual function 0 of")
for name, member in MEMBERS:
    if not hasattr(yade.wrapper, name):
        continue  # Polyhedra in a YADE without CGAL
    place = offset(name, member)
    expected = f"{name}.{member}: expected offset {place[0]}, found offset {place[0] + 8}"
    changed(place, [place[0] + 8], expected)
for base, derived, first in SIZES:
    place = offset(derived, first)
    changed(place, [place[0] + 8], f"{base}: expected a size of {place[0]}")

assert not hasattr(yade.wrapper, "MasonryMat")
isUntouched = lambda: O.engines == before and len(O.bodies) == 1 and O.thisScene == scenes
assert isUntouched()
import masonry  # the module that fits
assert isUntouched()
O.reset()
O.bodies.append(utils.sphere((0, 0, 0), 1))
O.engines = [ForceResetter(), NewtonIntegrator(gravity=(0, 0, -10), damping=0)]
O.dt = 0.1
O.step()
assert abs(O.bodies[0].state.vel[2] + 1) < 1e-12
print("ALL REFUSED")
"""


def test_a_yade_with_another_table_member_or_size_is_refused_by_name_and_stays_usable():
    """A function more, fewer or exchanged in each class, each member moved, each base grown: one
    line each. A function more in Shape is what YADE 2026.1.0 has, which a check of some functions
    of each class took for fitting.
    """
    assert len(TABLES) > 20 and len(MEMBERS) > 40 and len(SIZES) > 10
    lists = f"MODULE, TABLES, MEMBERS, SIZES = {MODULE!r}, {TABLES}, {MEMBERS}, {SIZES}"
    ended = inFreshYade(lists + FAULTS)
    assert "ALL REFUSED" in ended.stdout, ended.stdout + ended.stderr


def test_every_class_that_is_declared_with_virtual_functions_is_compared():
    headers = source("Yade.hpp") + source("YadeGl.hpp")
    declared = set(re.findall(r"class (\w+)[^;{]*{\s*MASONRY_HOST_CLASS", headers))
    bases = {"Factorable", "Serializable"}  # which write their functions out
    assert set(TABLES) == (declared | bases) - {"Polyhedra", "InteractionContainer"}


def test_the_module_shows_only_what_must_be_one_with_the_host():
    listing = run("nm", "-DC", "--defined-only", MODULE).stdout
    names = [line.split(maxsplit=2)[2] for line in listing.splitlines()]
    allowed = re.compile(
        r"PyInit__masonry$"
        r"|(vtable|typeinfo|typeinfo name) for yade::"  # of YADE's classes
        r"|.*boost::(serialization|archive)::.*\byade::"  # who saves objects of YADE's classes
        r"|.*masonry::host::Declared<yade::"  # what the self-check compares
    )
    assert [name for name in names if not allowed.match(name)] == []
    assert any("extended_type_info_typeid<yade::Material>" in name for name in names)


UNKNOWN = """
import yade.config
yade.config.version = "2099.1"
import warnings
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    try:
        import masonry
        print("TAKEN", masonry.MasonryMat().young)
    except ImportError as error:
        print("REFUSED:", error)
for warning in told:
    print("WARNED:", warning.category.__name__, warning.message)
"""


@mark.slow
def test_a_yade_of_an_unknown_version_is_used_on_the_users_word_only(monkeypatch):
    monkeypatch.delenv("MASONRY_UNKNOWN_YADE", raising=False)
    ended = inFreshYade(UNKNOWN)
    assert "REFUSED: " in ended.stdout, ended.stdout + ended.stderr
    assert "YADE version: 2099.1 is not known" in ended.stdout
    assert "MASONRY_UNKNOWN_YADE=1" in ended.stdout and "TAKEN" not in ended.stdout
    monkeypatch.setenv("MASONRY_UNKNOWN_YADE", "1")
    ended = inFreshYade(UNKNOWN)
    assert "TAKEN 4800000000.0" in ended.stdout, ended.stdout + ended.stderr
    assert "WARNED: RuntimeWarning YADE 2099.1 is not known" in ended.stdout


@mark.slow
def test_a_yade_of_another_precision_is_refused_by_name(tmp_path):
    program = shutil.which("yade-mpfr150")
    built = run("cmake", "-S", ROOT, "-B", str(tmp_path), f"-DMASONRY_YADE={program}")
    assert built.returncode and f"the YADE of {program} does not" in built.stderr
    ended = run(program, "-n", "-x", f"{ROOT}/tests/host/checkMasonryJoint.py")
    assert ended.returncode and "of 150 digits, does not fit" in ended.stderr


@mark.slow
def test_the_running_version_is_a_known_one_without_a_warning():
    ended = inFreshYade(UNKNOWN.replace('yade.config.version = "2099.1"', ""))
    assert "TAKEN" in ended.stdout and "WARNED" not in ended.stdout, ended.stdout
