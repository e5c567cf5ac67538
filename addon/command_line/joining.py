# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices that a file splits, where corners differ by normals or UVs, or every seam would be a boundary."""

from itertools import compress

import bmesh
import numpy as np

from .. import compatibility
from ..compatibility import Values
from ..scene import mesh_io

SAME_PLACE = 1e-6  # part of a mesh's largest extent: equal positions, for Blender joins nothing at a distance of 0
ROUNDED = 4  # steps of single precision at the largest coordinate: far from the origin they are longer than that part


def join(mesh):
    """Joins vertices that are in the very same place, and stay so in every shape key and pose: lips do not grow
    together. Faces that lie back to back stay two. Normals of corners stay."""
    if not len(mesh.vertices):
        return
    normals, places = mesh_io.corner_normals(mesh), mesh_io.read_values(compatibility.position_values(mesh))
    distance, kinds = _distance(places), _kinds(mesh, places)
    edited = bmesh.new()
    edited.from_mesh(mesh)
    sheets = _sheets(mesh, _joined(edited, kinds, distance))
    for alike in _groups(edited, kinds + (kinds.max() + 1) * sheets):
        bmesh.ops.remove_doubles(edited, verts=alike, dist=distance)
    edited.to_mesh(mesh)
    edited.free()
    if len(mesh.loops) == len(normals):
        compatibility.set_corner_normals(mesh, normals)
    mesh.update()


def _distance(places):
    """Within which positions are equal."""
    rounding = ROUNDED * float(np.spacing(np.abs(places).max()))
    return max(SAME_PLACE * float(np.ptp(places, axis=0).max()), rounding)


def _groups(edited, numbers):
    """The vertices of each number, as lists."""
    return [list(compress(edited.verts, (numbers == number).tolist())) for number in np.unique(numbers)]


def _joined(edited, kinds, distance):
    """(#V,) the vertex that each would be joined into."""
    into = np.arange(len(kinds))
    edited.verts.index_update()
    for alike in _groups(edited, kinds):
        found = bmesh.ops.find_doubles(edited, verts=alike, dist=distance)["targetmap"]
        pairs = np.array([(one.index, other.index) for one, other in found.items()], int).reshape(-1, 2)
        into[pairs[:, 0]] = pairs[:, 1]
    return into


def _sheets(mesh, into):
    """(#V,) 0, or more on the faces that would get the same vertices as earlier ones, which Blender would delete."""
    polygons = mesh_io.read_polygons(mesh, np.eye(3))
    starts, sizes, sheets = polygons.face_offsets[:-1], np.diff(polygons.face_offsets), np.zeros(len(into), int)
    for size in np.unique(sizes):
        corners = polygons.corner_vertices[starts[sizes == size][:, None] + np.arange(size)]
        _, places = np.unique(np.sort(into[corners], axis=1), axis=0, return_inverse=True)
        np.maximum.at(sheets, corners, _ranks(places.ravel())[:, None])
    return sheets


def _ranks(numbers):
    """(n,) how many equal ones come before each."""
    order = np.argsort(numbers, kind="stable")
    ranks = np.empty(len(numbers), int)
    ranks[order] = np.arange(len(numbers)) - np.searchsorted(numbers[order], numbers[order])
    return ranks


def _kinds(mesh, places):
    """(#V,) a number for each way to move that vertices of one place have, from 0 on in each place."""
    place, _ = _numbered(places)
    kind, first = _numbered(np.column_stack([place, _key_positions(mesh), _weights(mesh)]))
    return _ranks(place[first])[kind]


def _numbered(rows):
    """The same number for equal rows, and a row of each number; compared as bytes, which is ten times faster."""
    rows = np.ascontiguousarray(rows + rows.dtype.type(0))  # -0 is 0
    keys = rows.view(np.dtype((np.void, rows.dtype.itemsize * rows.shape[1])))[:, 0]
    _, first, number = np.unique(keys, return_index=True, return_inverse=True)
    return number.ravel(), first


def _key_positions(mesh):
    """(#V, 3 #keys) positions in the shape keys."""
    blocks = mesh.shape_keys.key_blocks if mesh.shape_keys else ()
    positions = [mesh_io.read_values(Values(block.data, "co", np.float32, 3)) for block in blocks]
    return np.concatenate([np.empty((len(mesh.vertices), 0), np.float32), *positions], axis=1)


def _weights(mesh):
    """(#V, #groups), up to the last group that is used; one by one, for Blender has no array of them."""
    entries = [(vertex.index, g.group, g.weight) for vertex in mesh.vertices for g in vertex.groups]
    vertices, groups, weights = np.array(entries, np.float64).reshape(-1, 3).T
    found = np.zeros((len(mesh.vertices), int(groups.max(initial=-1)) + 1), np.float32)
    found[vertices.astype(int), groups.astype(int)] = weights
    return found
