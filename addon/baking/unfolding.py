# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that lie over themselves nowhere: ours on parts that unfold, elsewhere those of Blender's Smart UV Project.

A projection lays the turns of a spring over each other: pieces whose islands overlap are halved and projected anew.
"""

import math

import bpy
import numpy as np

from ..maps import packing
from ..native import holomorph
from ..scene import mesh_io, uv_maps
from ..solving.jobs import REFUSALS

MOST_COST = 0.8  # of our islands, see the package's `appearance`: with more, a projection has fewer seams
ANGLE = math.radians(66)  # between faces and the direction that they are projected along, Blender's own
FLAT, REST = 0, 1  # pieces: parts that unfold, and the rest


def islands(context, joined, meshes):
    """(#C, 2) float32, with nearly a UV unit for a unit of length; islands may lie over other ones.

    joined : the meshes as `packing.joined` lays them side by side, `mesh_io.Polygons` all
    """
    uv = np.full((len(joined.corner_vertices), 2), np.nan, np.float32)
    piece = np.full(joined.face_count, REST)
    corner = face = 0
    for polygons in meshes:
        for part in _parts(polygons):
            flat = _flat(part)
            piece[face + part.face_index] = piece.max() + 1 if flat is None else FLAT
            if flat is not None:
                uv[corner + part.corner_index] = flat
        corner, face = corner + len(polygons.corner_vertices), face + polygons.face_count
    is_left = np.isnan(uv).any(axis=1)
    if is_left.any():
        found = _projected(context, joined, piece)
        ratio = holomorph.distortion.length_ratio(joined, found)
        uv[is_left] = found[is_left] / (ratio or 1.0)
    return uv


def _parts(polygons):
    """Connected parts; none of what is not a surface."""
    try:
        return polygons.surface(strict=False).components
    except REFUSALS:
        return ()


def _flat(part):
    """(#C, 2) islands of a part that do not overlap and look good; None where there are none."""
    try:
        found = holomorph.island_map(part)
    except REFUSALS:
        return None
    if found is None or found.cost > MOST_COST:
        return None
    return found.uv if found.quality.overlapping_part <= holomorph.quality.appearance.ROUNDING else None


def _projected(context, joined, piece):
    """(#C, 2) float32; halves pieces until none but flat ones lies over itself."""
    while True:
        found = _smart(context, joined, piece)
        halved = _halved(joined, piece, found)
        if np.array_equal(halved, piece):
            return found
        piece = halved


def _smart(context, joined, piece):
    """(#C, 2) float32 of Smart UV Project, for pieces that share no vertex."""
    count = len(joined.vertices)
    keys = np.repeat(piece, np.diff(joined.face_offsets)) * count + joined.corner_vertices
    keys, corner_vertices = np.unique(keys, return_inverse=True)
    apart = mesh_io.Polygons(joined.vertices[keys % count], corner_vertices.reshape(-1), joined.face_offsets, None)
    with packing.mesh_of(context, apart) as mesh:
        uv_maps.write_map(mesh, apart, uv_maps.BAKE_MAP, np.zeros((len(corner_vertices), 2), np.float32))
        with packing.editing_all(context):
            bpy.ops.uv.smart_project(angle_limit=ANGLE, island_margin=0.0)
        return np.nan_to_num(uv_maps.read_map(mesh, uv_maps.BAKE_MAP))


def _halved(joined, piece, uv):
    """The pieces, those of several faces that lie over themselves halved across the direction they are longest in."""
    ends, is_border = _edges(joined.face_offsets, uv)
    of_corner = np.repeat(piece, np.diff(joined.face_offsets))
    order, by_corner = np.argsort(piece, kind="stable"), np.argsort(of_corner[is_border], kind="stable")
    labels, first = np.unique(piece[order], return_index=True)
    borders = ends[is_border][by_corner]
    starts = np.searchsorted(of_corner[is_border][by_corner], labels)
    halved, middles = piece.copy(), _middles(joined)
    for label, faces, border in zip(labels, np.split(order, first[1:]), np.split(borders, starts[1:])):
        if label != FLAT and len(faces) > 1 and _overlaps(border):
            halved[faces[_is_far(middles[faces])]] = halved.max() + 1
    return halved


def _edges(face_offsets, uv):
    """((#C, 2) complex ends of the directed edges, whether no other one runs back along it)."""
    following = np.arange(1, len(uv) + 1)
    following[face_offsets[1:] - 1] = face_offsets[:-1]
    ends = uv.astype(np.float64) @ [1, 1j]
    ends = np.column_stack([ends, ends[following]])
    _, number = np.unique(np.concatenate([ends, ends[:, ::-1]]), axis=0, return_inverse=True)
    forth, back = np.split(number.reshape(-1), 2)
    return ends, ~np.isin(forth, back)


def _overlaps(border):
    quality = holomorph.quality
    return len(border) > 0 and quality.appearance.overlapping_part(border) > quality.appearance.ROUNDING


def _middles(polygons):
    sums = np.add.reduceat(polygons.vertices[polygons.corner_vertices], polygons.face_offsets[:-1])
    return sums / np.diff(polygons.face_offsets)[:, None]


def _is_far(points):
    """(n,) bool: the half that is farther along the direction in which points lie farthest apart."""
    _, axes = np.linalg.eigh(np.cov(points.T))
    far = np.zeros(len(points), bool)
    far[np.argsort(points @ axes[:, -1], kind="stable")[len(points) // 2 :]] = True
    return far
