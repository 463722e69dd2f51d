# SPDX-License-Identifier: GPL-2.0-or-later
"""A run as a glTF 2.0 file (.glb) for Blender, PowerPoint and what else shows 3-D models. This module needs no YADE.

Such a file has metres as its unit, and y is up in it: a node above all others turns z up to that.
"""

import json
import struct

import numpy as np

from ..basics import Refused, plain
from ..folders import replaced
from .motion import CRUSHED_TOO, OPEN, SLID, Cracks, Motion

FLOAT, BYTE = 5126, 5121  # numbers of glTF for types of numbers
VERTICES = 34962  # number of glTF for an array of vertices
UP = [
    -(0.5**0.5),
    0.0,
    0.0,
    0.5**0.5,
]  # the rotation that turns z to y, (x, y, z, w)

#: Colours as a screen shows them, from 0 to 255; those of joints are as in cracks.png.
BRICK, PLATEN = (240, 222, 191), (185, 189, 194)
KINDS = {OPEN: (214, 39, 40), SLID: (31, 119, 180), CRUSHED_TOO: (16, 16, 16)}


def write(directory, path, number=None, magnification=1.0, rate=10):
    """Write a run to a .glb file, whole or not at all.

    :param directory: folder of results
    :param number: of the frame whose deformed shape is written, with its cracks as coloured faces, from 0. None: all
        frames as an animation of the blocks, without cracks; of a run with deformable units, or with one frame alone, the
        last one
    :param magnification: of displacements [-]. In an animation a block stays rigid: its centre moves so many times as far,
        and it turns by so many times the angle
    :param rate: frames of the animation a second
    :returns: a sentence on what is in the file
    :raises Refused: as of :class:`masonry.read.motion.Motion`
    :raises OSError: if the file cannot be written, or if its name is that of a symbolic link
    """
    motion = Motion(directory, number)
    if number is None and (len(motion.times) == 1 or not motion.rigid.all()):
        motion = Motion(directory, motion.numbers[-1])
    model = _Model(motion.title)
    blocks = f"{len(motion.bodies):,} blocks"
    if len(motion.times) == 1:
        faces = model.still(motion, magnification)
        says = f"{blocks} in frame {motion.numbers[0]}, {faces:,} points of joints that are cracked or crushed"
    else:
        model.animation(motion, magnification, rate)
        says = f"{blocks}, an animation of {len(motion.times)} frames at {rate} a second, without cracks"
    data = model.bytes()
    with replaced(path, "wb") as file:
        file.write(data)
    return f"{path}: {says}, displacements × {magnification:g}, {len(data) / 1e6:.2f} MB"  # fmt: skip


class _Model:
    """What goes into a file."""

    def __init__(self, title):
        self._parts, self._size = [], 0
        self._root = {"name": plain(title), "rotation": UP, "children": []}
        self._json = {
            "asset": {"version": "2.0", "generator": "masonry for YADE"},
            "scene": 0,
            "scenes": [{"nodes": [0], "name": plain(title)}],
            "nodes": [self._root],
            "meshes": [],
            "materials": [],
            "accessors": [],
            "bufferViews": [],
        }

    def _add(self, name, value):
        """Append to a list of the file; the number of what was appended."""
        self._json[name].append(value)
        return len(self._json[name]) - 1

    def _array(self, values, kind, of, vertices=False, bounds=False, normalized=False):
        """Append an array of rows; the number of its accessor."""
        data = np.ascontiguousarray(values, "<f4" if kind == FLOAT else "u1")
        view = {"buffer": 0, "byteOffset": self._size, "byteLength": data.nbytes}
        accessor = {
            "bufferView": self._add("bufferViews", {**view, **({"target": VERTICES} if vertices else {})}),
            "componentType": kind,
            "count": len(data),
            "type": of,
        }  # fmt: skip
        if bounds:
            rows = data.reshape(len(data), -1)
            accessor.update(min=rows.min(axis=0).tolist(), max=rows.max(axis=0).tolist())  # fmt: skip
        if normalized:
            accessor["normalized"] = True
        self._parts.append(data.tobytes() + b"\0" * (-data.nbytes % 4))
        self._size += len(self._parts[-1])
        return self._add("accessors", accessor)

    def _material(self, name, colour, bothSides=False):
        made = {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*linear(colour), 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}}  # fmt: skip
        if bothSides:
            made["doubleSided"] = True
        return self._add("materials", made)

    def _primitive(self, corners, material, colours=None):
        """Triangles with flat sides, of an array (n, 3, 3) of their corners."""
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        lengths = np.linalg.norm(normals, axis=1)
        fine = lengths > 0
        corners, normals = corners[fine], normals[fine] / lengths[fine, None]
        attributes = {
            "POSITION": self._array(corners.reshape(-1, 3), FLOAT, "VEC3", True, True),
            "NORMAL": self._array(np.repeat(normals, 3, axis=0), FLOAT, "VEC3", True),
        }
        if colours is not None:
            attributes["COLOR_0"] = self._array(np.repeat(colours[fine], 3, axis=0), BYTE, "VEC4", True, normalized=True)  # fmt: skip
        return {"attributes": attributes, "material": material}

    def _node(self, node):
        self._root["children"].append(self._add("nodes", node))

    def still(self, motion, magnification):
        """The deformed shape of the only frame; returns how many points of joints are drawn."""
        points = motion.points + magnification * motion.displacements(0)
        brick = motion.brick[motion.owner[motion.triangles[:, 0]]]
        for name, chosen, colour in (("bricks", brick, BRICK), ("platens", ~brick, PLATEN)):  # fmt: skip
            if chosen.any():
                part = self._primitive(points[motion.triangles[chosen]], self._material(name, colour))  # fmt: skip
                mesh = self._add("meshes", {"name": name, "primitives": [part]})
                self._node({"name": name, "mesh": mesh})
        cracks = Cracks(motion)
        kinds = cracks.kind[0]
        shown = np.flatnonzero(kinds)
        if len(shown):
            corners = cracks.points + magnification * cracks.displacements(motion, 0)
            fans, colours = [], []
            for n in shown:
                cell = cracks.cells[n]
                bit = next(b for b in (CRUSHED_TOO, OPEN, SLID) if kinds[n] & b)
                colour = np.append(np.rint(255 * linear(KINDS[bit])), 255)
                for a, b in zip(cell[1:], cell[2:]):
                    fans.append((cell[0], a, b))
                    colours.append(colour)
            part = self._primitive(corners[np.array(fans)], self._material("joints", (255, 255, 255), True), np.array(colours))  # fmt: skip
            mesh = self._add("meshes", {"name": "joints", "primitives": [part]})
            self._node({"name": "joints", "mesh": mesh})
        return len(shown)

    def animation(self, motion, magnification, rate):
        """Every block as a node that moves. Blocks of one shape share a mesh."""
        materials = [self._material("platens", PLATEN), self._material("bricks", BRICK)]
        times = self._array(np.arange(len(motion.times)) / rate, FLOAT, "SCALAR", bounds=True)  # fmt: skip
        channels, samplers, meshes = [], [], {}
        order = np.argsort(motion.owner[motion.triangles[:, 0]], kind="stable")
        triangles = motion.triangles[order]
        starts = np.searchsorted(motion.owner[triangles[:, 0]], np.arange(len(motion.bodies) + 1))  # fmt: skip
        for block, body in enumerate(motion.bodies.tolist()):
            centre = motion.centres[block]
            corners = motion.points[triangles[starts[block] : starts[block + 1]]] - centre  # fmt: skip
            brick = bool(motion.brick[block])
            key = brick, np.rint(corners / 1e-7).astype(int).tobytes()
            if key not in meshes:
                part = self._primitive(corners, materials[brick])
                meshes[key] = self._add("meshes", {"primitives": [part]})
            name = f"{'brick' if brick else 'platen'} {body}"
            node = {"name": name, "mesh": meshes[key], "translation": centre.tolist(), "extras": {"body": body}}  # fmt: skip
            self._node(node)
            shift = magnification * motion.shift[:, block]
            turn = magnification * motion.turn[:, block]
            for values, path, of in ((centre + shift, "translation", "VEC3"), (quaternions(turn), "rotation", "VEC4")):  # fmt: skip
                if (np.ptp(values, axis=0) > 0).any() or np.any(shift if of == "VEC3" else turn):  # fmt: skip
                    samplers.append({"input": times, "output": self._array(values, FLOAT, of)})  # fmt: skip
                    target = {"node": len(self._json["nodes"]) - 1, "path": path}
                    channels.append({"sampler": len(samplers) - 1, "target": target})
        if channels:
            self._json["animations"] = [{"name": "frames", "channels": channels, "samplers": samplers}]  # fmt: skip

    def bytes(self):
        """The file: a head, the JSON and the arrays."""
        body = b"".join(self._parts)
        made = {**self._json, "buffers": [{"byteLength": len(body)}]}
        text = json.dumps(made, allow_nan=False, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        if len(body) + len(text) > 0xFFFFFF00:
            raise Refused("the model is larger than the 4 GB that a .glb file may have")
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(body), b"BIN\0") + body
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def linear(colour):
    """A colour as light has it, from 0 to 1, of one as a screen has it, from 0 to 255."""
    share = np.array(colour) / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def quaternions(turns):
    """Rotation vectors, an array (n, 3) [rad], as quaternions (x, y, z, w), none more than half a turn from that before."""
    angle = np.linalg.norm(turns, axis=1)[:, None]
    found = np.hstack([0.5 * np.sinc(angle / (2 * np.pi)) * turns, np.cos(angle / 2)])
    flips = (found[1:] * found[:-1]).sum(axis=1) < 0
    found[1:] *= np.where(np.cumsum(flips) % 2, -1, 1)[:, None]
    return found
