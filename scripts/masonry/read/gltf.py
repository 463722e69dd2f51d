# SPDX-License-Identifier: GPL-2.0-or-later
"""A run as a glTF 2.0 file (.glb) for Blender, PowerPoint and what else shows 3-D models.

Such a file has metres as its unit, and y is up in it: a node above all others turns z up to that.
"""

import json
import struct

import numpy as np

from ..basics import Refused, plain
from ..common.folders import replaced
from . import painting
from .model import CRUSHED_TOO, LOOKS, OPEN, SLID, Model

FLOAT, BYTE = 5126, 5121  # numbers of glTF for types of numbers
UP = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]  # turns z to y, (x, y, z, w)
KINDS = {
    OPEN: painting.CRACKS["open"],
    SLID: painting.CRACKS["slid"],
    CRUSHED_TOO: painting.CRUSHED,
}


def write(directory, path, number=None, magnification=1.0, rate=10):
    """Write a run to a .glb file, whole or not at all.

    :param directory: folder of results
    :param number: of the frame whose deformed shape is written, with its cracks as coloured faces,
        from 0. None: all frames as an animation of the blocks, without cracks; of a run with
        deformable units, or with one frame alone, the last one
    :param magnification: of displacements [-]. In an animation a block stays rigid: its centre
        moves so many times as far, and it turns by so many times the angle
    :param rate: frames of the animation a second
    :returns: a sentence on what is in the file
    :raises Refused: as in :class:`masonry.read.model.Model`
    :raises OSError: if the file cannot be written, or if its name is that of a symbolic link
    """
    model = Model(directory, number)
    if number is None and (len(model.times) == 1 or not model.rigid.all()):
        model = Model(directory, model.numbers[-1])
    file = _File(model.title)
    blocks = f"{len(model.bodies):,} blocks"
    if len(model.times) == 1:
        faces = file.still(model, magnification)
        says = (
            f"{blocks} in frame {model.numbers[0]}, {faces:,} points of joints that are cracked or"
            " crushed"
        )
    else:
        file.animation(model, magnification, rate)
        says = (
            f"{blocks}, an animation of {len(model.times)} frames at {rate} a second, without"
            " cracks"
        )
    data = file.bytes()
    with replaced(path, "wb") as target:
        target.write(data)
    return f"{path}: {says}, displacements × {magnification:g}, {len(data) / 1e6:.2f} MB"


class _File:
    def __init__(self, title):
        self._parts, self._size = [], 0
        self._root = {"name": plain(title), "rotation": UP, "children": []}
        self._json = {
            "asset": {"version": "2.0", "generator": "masonry for YADE"},
            "scene": 0,
            "scenes": [{"nodes": [0], "name": plain(title)}],
            "nodes": [self._root],
            **{name: [] for name in ("meshes", "materials", "accessors", "bufferViews")},
        }

    def _add(self, name, value):
        """Append to a list of the file; the number of what was appended."""
        self._json[name].append(value)
        return len(self._json[name]) - 1

    def _array(self, values, of, kind=FLOAT):
        """Append an array of rows; the number of its accessor."""
        data = np.ascontiguousarray(values, "<f4" if kind == FLOAT else "u1")
        view = {"buffer": 0, "byteOffset": self._size, "byteLength": data.nbytes}
        rows = data.reshape(len(data), -1)
        accessor = {
            "bufferView": self._add("bufferViews", view),
            "componentType": kind,
            "count": len(data),
            "type": of,
        }
        if kind == FLOAT:
            accessor.update(min=rows.min(axis=0).tolist(), max=rows.max(axis=0).tolist())
        else:
            accessor["normalized"] = True
        self._parts.append(data.tobytes() + b"\0" * (-data.nbytes % 4))
        self._size += len(self._parts[-1])
        return self._add("accessors", accessor)

    def _material(self, name, colour):
        look = {
            "baseColorFactor": [*linear(colour), 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
        }
        return self._add(
            "materials",
            {"name": name, "pbrMetallicRoughness": look, "doubleSided": name == "joints"},
        )

    def _mesh(self, corners, material, colours=None):
        """Triangles with flat sides, of an array (n, 3, 3) of their corners; the number of the
        mesh."""
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        lengths = np.linalg.norm(normals, axis=1)
        fine = lengths > 0
        corners, normals = corners[fine], normals[fine] / lengths[fine, None]
        attributes = {
            "POSITION": self._array(corners.reshape(-1, 3), "VEC3"),
            "NORMAL": self._array(np.repeat(normals, 3, axis=0), "VEC3"),
        }
        if colours is not None:
            attributes["COLOR_0"] = self._array(np.repeat(colours[fine], 3, axis=0), "VEC4", BYTE)
        return self._add(
            "meshes", {"primitives": [{"attributes": attributes, "material": material}]}
        )

    def _node(self, **node):
        self._root["children"].append(self._add("nodes", node))

    def still(self, model, magnification):
        """The deformed shape of the only frame; returns how many points of joints are drawn."""
        points = model.points + magnification * model.displacements(0)
        looks = model.looks[model.owner[model.triangles[:, 0]]]
        for look, name in enumerate(LOOKS):
            chosen = model.triangles[looks == look]
            if len(chosen):
                self._node(
                    name=name,
                    mesh=self._mesh(points[chosen], self._material(name, painting.SHADES[name])),
                )
        joints = model.joints
        fans, colours = [], []
        for n in np.flatnonzero(joints.kind[0]):
            cell = np.flatnonzero(joints.owner == n)
            bit = next(b for b in (CRUSHED_TOO, OPEN, SLID) if joints.kind[0, n] & b)
            colour = np.append(np.rint(255 * linear(KINDS[bit])), 255)
            fans += [(cell[0], a, b) for a, b in zip(cell[1:], cell[2:])]
            colours += [colour] * (len(cell) - 2)
        if fans:
            # on the faces of both blocks
            corners = joints.corners + magnification * joints.displacements(0)
            both = np.concatenate([side[np.array(fans)] for side in corners])
            mesh = self._mesh(both, self._material("joints", "#ffffff"), np.tile(colours, (2, 1)))
            self._node(name="joints", mesh=mesh)
        return int((joints.kind[0] > 0).sum())

    def animation(self, model, magnification, rate):
        """Every block as a node that moves. Blocks of one shape share a mesh."""
        materials = [self._material(name, painting.SHADES[name]) for name in LOOKS]
        times = self._array(np.arange(len(model.times)) / rate, "SCALAR")
        channels, samplers, meshes = [], [], {}
        order = np.argsort(model.owner[model.triangles[:, 0]], kind="stable")
        triangles = model.triangles[order]
        starts = np.searchsorted(model.owner[triangles[:, 0]], np.arange(len(model.bodies) + 1))
        for block, body in enumerate(model.bodies.tolist()):
            centre, look = model.centres[block], int(model.looks[block])
            corners = model.points[triangles[starts[block] : starts[block + 1]]] - centre
            key = look, np.rint(corners / 1e-7).astype(int).tobytes()
            if key not in meshes:
                meshes[key] = self._mesh(corners, materials[look])
            self._node(
                name=f"{LOOKS[look]} {body}",
                mesh=meshes[key],
                translation=centre.tolist(),
                extras={"body": body},
            )
            shift = magnification * model.shift[:, block]
            turn = magnification * model.turn[:, block]
            for moves, values, path, of in (
                (shift, centre + shift, "translation", "VEC3"),
                (turn, quaternions(turn), "rotation", "VEC4"),
            ):
                if moves.any():
                    samplers.append({"input": times, "output": self._array(values, of)})
                    target = {"node": len(self._json["nodes"]) - 1, "path": path}
                    channels.append({"sampler": len(samplers) - 1, "target": target})
        if channels:
            self._json["animations"] = [
                {"name": "frames", "channels": channels, "samplers": samplers}
            ]

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
    """Red, green and blue as light has them, from 0 to 1, of a colour "#rrggbb" as a screen has
    it."""
    share = painting.rgb(colour) / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def quaternions(turns):
    """Rotation vectors, an array (n, 3) [rad], as quaternions (x, y, z, w), none more than half a
    turn from that before."""
    angle = np.linalg.norm(turns, axis=1)[:, None]
    found = np.hstack([0.5 * np.sinc(angle / (2 * np.pi)) * turns, np.cos(angle / 2)])
    flips = (found[1:] * found[:-1]).sum(axis=1) < 0
    found[1:] *= np.where(np.cumsum(flips) % 2, -1, 1)[:, None]
    return found
