"""Native surfaces of checked arrays. Those of meshes come with their `Origin`."""

import os

import numpy as np

from .. import _native
from .._native import InvalidMesh
from ..core import arrays
from ..core.value import quoted
from .origin import AS_GIVEN, Origin
from .other_packages import given_polygons


def of_faces(vertices, faces, strict):
    """Makes one of the arguments of `Surface`."""
    if faces is None:
        return of_polygons(*given_polygons(vertices), strict)
    return _of(arrays.real(vertices, 3, "vertices"), *arrays.polygons(faces), strict)


def of_polygons(vertices, corner_vertices, face_offsets, strict):
    """Makes one of the arguments of `Surface.from_polygons`."""
    return _of(
        arrays.real(vertices, 3, "vertices"),
        arrays.integer(corner_vertices, "corner_vertices"),
        arrays.integer(face_offsets, "face_offsets"),
        strict,
    )


def of_file(path, strict, weld, up):
    """Makes one of the arguments of `Surface.read`."""
    if up not in (None, "Y", "Z"):
        raise ValueError(f'up is {quoted(up)}; "Y" or "Z" is needed')
    return of_read(_native.FileMesh.read(os.fspath(path), weld), path, strict, up)


def of_read(file, path, strict, up):
    """Makes one of a native `FileMesh`, from which its arrays are then gone."""
    part = file.surface(strict)
    return part.surface, Origin.of_part(part, up or ("Y" if str(path).lower().endswith(".obj") else "Z"))


def _of(vertices, corner_vertices, face_offsets, strict):
    if strict:
        surface = _native.Surface.from_polygons(vertices, corner_vertices, face_offsets)
        surface.refuse_wild_vertices()
        return surface, AS_GIVEN
    part = _native.Surface.cut(vertices, corner_vertices, face_offsets)
    return part.surface, Origin.of_part(part)


def of_edge_lengths(faces, edge_lengths, face_edges):
    """Makes one, without an `Origin`, of the arguments of `Surface.from_edge_lengths`."""
    faces = arrays.integer(faces, "faces", dimensions=2, columns=(3,))
    names = np.empty((0, 3), np.int64) if face_edges is None else arrays.integer(face_edges, "face_edges", 2, (3,))
    if face_edges is not None and len(names) != len(faces):
        raise InvalidMesh(f"face_edges has {len(names)} rows for {len(faces)} faces")
    vertex_count = int(faces.max()) + 1 if faces.size else 0
    if vertex_count > 2 * faces.size + 2**20:
        raise InvalidMesh(f"faces name vertex {vertex_count - 1}, far beyond what {len(faces)} triangles can use")
    lengths = arrays.real(edge_lengths, 3, "edge_lengths")
    return _native.Surface.from_edge_lengths(vertex_count, faces, lengths, names)
