# SPDX-License-Identifier: GPL-2.0-or-later
"""Byte offsets of the data members of YADE's classes, as the running YADE reports them through
Python.

    yade -n -x yade_plugin/host/offsets.py [CLASS...]

Without names: the classes that Yade.hpp declares. An attribute is listed under the class that
defines it. Attributes that Python reads by calling a function have no offset and are left out.
"""

import ctypes
import os
import re
import sys

import yade.wrapper

HEADER = object.__basicsize__  # [bytes] of every Python object: reference count and type
POINTER = ctypes.sizeof(ctypes.c_void_p)
DATA_MEMBER = b"6callerINS3_6memberI"  # "caller<member<" in the mangled type name of a caller


def pointerAt(address):
    return ctypes.c_void_p.from_address(address).value


def memberOffset(getter):
    """Offset that a getter of Boost.Python reads at, or None if it calls a function.

    The Python function object holds, after its header, a pointer to its caller object. That object
    begins with the pointer to its virtual function table, and then holds the C++ pointer to the
    data member, which is the offset. The word before slot 0 of the table leads to the type
    information of the caller, whose second word is its name.
    """
    if "Boost" not in type(getter).__module__:
        return None
    caller = pointerAt(id(getter) + HEADER)
    typeInformation = pointerAt(pointerAt(caller) - POINTER)
    if DATA_MEMBER not in ctypes.string_at(pointerAt(typeInformation + POINTER)):
        return None
    return ctypes.c_int64.from_address(caller + POINTER).value


def membersOf(cls):
    """(offset, name) of the attributes that a class itself defines, in the order in which they
    lie."""
    members = []
    for name, attribute in vars(cls).items():
        if isinstance(attribute, property):
            offset = memberOffset(attribute.fget)
            if offset is not None:
                members.append((offset, name))
    return sorted(members)


def declaredClasses():
    """Names of the classes that Yade.hpp and YadeGl.hpp declare."""
    names = []
    for header in ("Yade.hpp", "YadeGl.hpp"):
        path = os.path.join(os.path.dirname(os.path.abspath(sys.argv[0])), header)
        with open(path, encoding="utf-8") as f:
            names += re.findall(r"^class (\w+)[^;]*\{", f.read(), re.MULTILINE)
    return names


for name in sys.argv[1:] or declaredClasses():
    cls = getattr(yade.wrapper, name, None)
    if cls is None:
        print(f"{name}: not known to Python")
        continue
    print(f"{name}, derived from {cls.__bases__[0].__name__}")
    for offset, member in membersOf(cls):
        print(f"{offset:6d}  {member}")
