# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of a tiling as wires: points joined by edges, and the Geometry Nodes that make tubes of them."""

import numpy as np

from . import parts
from .tree import POSITION, Dial, Followed, made_once, number

NAME = "Holomorphic Lines on Tiling"
VERSION = 2  # of the nodes
THICKNESS = 0.06  # radius of a wire, in sides of a tile
DIRECTIONS = {"U": ["u"], "V": ["v"], "BOTH": ["u", "v"]}

DIALS = {
    "Surface": Dial("Object"),
    "Radius": Dial("Float", {"default_value": 0.01, "min_value": 0.0}),
    "Height": number(),
    "Sides": Dial("Int", {"default_value": 8, "min_value": 3, "max_value": 64}),
    "Other Side": Dial("Bool"),
    "Material": Dial("Material"),
}


def found(tiled, progress, directions, per_tile):
    """The attributes of the points, by name, with the "edges" that join them, the "side" of a tile, and the "count" of
    lines."""
    directions = directions[:1] if tiled.turns > 2 else directions  # which are all, once turned
    lines = [tiled.lines(direction, per_tile, progress) for direction in directions]
    counts = np.cumsum([0, *(len(one.triangles) for one in lines)])
    edges = [_edges(one) + begin for one, begin in zip(lines, counts)]
    values = parts.joined([parts.surface_values(one) for one in lines])
    return values | {"edges": np.concatenate(edges), "side": _side(tiled), "count": sum(map(len, lines))}


def joined(dictionaries):
    """The attributes of all parts together, whose "side" and "count" are arrays."""
    begin = np.cumsum([0, *(len(one[POSITION]) for one in dictionaries)])
    own = [
        one | {"edges": one["edges"] + first, "side": [one["side"]], "count": [one["count"]]}
        for one, first in zip(dictionaries, begin)
    ]
    return parts.joined(own)


def _edges(lines):
    """(n, 2) from each point to the next on its line, and from the last of a closed line to the first."""
    count = len(lines.triangles)
    following = np.arange(1, count + 1)
    following[lines.offsets[1:] - 1] = lines.offsets[:-1]
    edges = np.stack([np.arange(count), following], axis=1)
    return np.delete(edges, lines.offsets[1:][~lines.is_closed] - 1, axis=0)


def _side(tiled):
    """The root of the mean area of a UV unit, in space."""
    uv = tiled.uv[tiled.surface.triangle_corners]
    a, b = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    area = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2
    return np.sqrt(tiled.surface.area / area)


def group():
    return made_once(NAME, VERSION, DIALS, _build)


def _build(tree):
    surface, radius = Followed(tree), tree.dial("Radius")
    moved = tree.times(surface.normal(), tree.number("MULTIPLY", tree.dial("Height"), radius))
    place = tree.vector("ADD", surface.place, moved)
    points = tree.node("GeometryNodeSetPosition", tree.dial("Geometry"), named={"Position": place})
    curves = tree.node("GeometryNodeMeshToCurve", points)
    profile = tree.node(
        "GeometryNodeCurvePrimitiveCircle", named={"Resolution": tree.dial("Sides"), "Radius": radius}, mode="RADIUS"
    )
    named = {"Curve": curves, "Profile Curve": profile, "Fill Caps": True}
    smooth = tree.node("GeometryNodeSetShadeSmooth", tree.node("GeometryNodeCurveToMesh", named=named))
    tree.finish(tree.node("GeometryNodeSetMaterial", smooth, named={"Material": tree.dial("Material")}))
