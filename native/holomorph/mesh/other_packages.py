"""Meshes of other packages, by the names of their arrays; none of these packages is imported."""

from __future__ import annotations

import numpy as np

from .._native import InvalidMesh
from ..core import arrays

POLYGONS = ("triangle", "quad", "polygon")  # of meshio, whose other cells are points, lines, solids or curved


def given_polygons(mesh):
    """(vertices, corner_vertices, face_offsets) of a trimesh.Trimesh, meshio.Mesh, pyvista.PolyData or Open3D mesh, or
    of anything with the same attributes. @throws InvalidMesh for another object"""
    has = {
        name for name in ("vertices", "points", "faces", "triangles", "cells", "face_offsets") if hasattr(mesh, name)
    }
    if {"vertices", "face_offsets"} <= has:
        return mesh.vertices, mesh.corner_vertices, mesh.face_offsets
    if {"vertices", "faces"} <= has:
        return np.asarray(mesh.vertices), *arrays.polygons(np.asarray(mesh.faces))
    if {"vertices", "triangles"} <= has:
        return np.asarray(mesh.vertices), *arrays.polygons(np.asarray(mesh.triangles))
    if {"points", "cells"} <= has and not isinstance(mesh.cells, np.ndarray):
        return np.asarray(mesh.points), *_of_blocks(mesh.cells)
    if {"points", "faces"} <= has:
        return np.asarray(mesh.points), *_of_padded(arrays.integer(mesh.faces, "faces"))
    raise InvalidMesh(
        f"one {type(mesh).__name__} is no mesh: pass Surface(vertices, faces), arrays of (#V, 3) reals and (#F, 3) "
        "integers, or an object with vertices and faces, points and cells, or points and faces"
    )


def _of_blocks(blocks):
    """(corner_vertices, face_offsets) of the `cells` of meshio: the polygons, one kind after the other."""
    found = [arrays.polygons(block.data) for block in blocks if block.type in POLYGONS]
    if not found:
        kinds = ", ".join(sorted({block.type for block in blocks})) or "none"
        raise InvalidMesh(f"the mesh has no cells of type {', '.join(POLYGONS)}; its cells: {kinds}")
    corners, sizes = np.concatenate([one for one, _ in found]), np.concatenate([np.diff(ends) for _, ends in found])
    return corners, np.concatenate([[0], np.cumsum(sizes)])


def _of_padded(padded):
    """(corner_vertices, face_offsets) of the `faces` of PyVista: before the corners of each polygon stands how many."""
    count = len(padded)
    following = np.clip(np.arange(count) + 1 + np.maximum(padded, 0), 0, count)
    following = np.append(following, count)  # the end leads to itself
    is_start = np.zeros(count + 1, bool)
    is_start[0] = True
    while not is_start[count]:  # twice as far in each round
        is_start[following[is_start]] = True
        following = following[following]
    starts = np.flatnonzero(is_start[:count])
    if padded[starts].sum() + len(starts) != count:
        raise InvalidMesh(f"faces is not padded: its {count} numbers are no sequence of n and n vertices")
    return np.delete(padded, starts), np.concatenate([[0], np.cumsum(padded[starts])])
