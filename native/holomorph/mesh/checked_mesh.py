"""Native surfaces of checked arrays, and back. Those of meshes come with their `Origin`. Meshes of other packages are
known by the names of their arrays; none of these packages is imported.
"""

from __future__ import annotations

import contextlib
import os

import numpy as np

from .. import _native
from .._native import Error, InvalidMesh
from ..core import arrays
from ..core.value import quoted
from ..files import formats, scenes
from .origin import AS_GIVEN, Origin

POLYGONS = ("triangle", "quad", "polygon")  # of meshio, whose other cells are points, lines, solids or curved


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
    formats.require_reader(path)
    if scene := scenes.kind(path):
        polygons, notes = scenes.read(path, weld or strict)
        with naming(path):
            surface, origin = _of(*polygons, strict)
        return surface, origin._replace(up=up or scene.UP, notes=notes)
    file = _native.FileMesh.read(os.fspath(path), weld)
    with naming(path):
        part = file.surface(strict)  # whose arrays are then gone from the file
    return part.surface, Origin.of_part(part, up or ("Y" if str(path).lower().endswith(".obj") else "Z"))


@contextlib.contextmanager
def naming(path):
    """What a file holds may be refused once it is read: its path is told then, too."""
    try:
        yield
    except Error as error:
        raise type(error)(f"{os.fsdecode(path)}: {error}") from error


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


def arrays_of(native):
    """(vertices, corner vertices, face offsets), or of an intrinsic surface (number of vertices, faces, edge lengths,
    names of edges), (#F, 3) each, as `Surface.from_edge_lengths` takes them."""
    if not native.intrinsic:
        return tuple(np.array(part) for part in (native.vertices, native.corner_vertices, native.face_offsets))
    names = np.empty(len(native.corner_vertices), np.int64)
    names[native.triangle_corners] = native.triangle_edges[:, [1, 2, 0]]  # the edge opposite each corner
    faces = native.corner_vertices.astype(np.int64).reshape(-1, 3)
    names = names.reshape(-1, 3)
    return native.vertex_count, faces, native.edge_lengths[names], names


def native_of(made_of):
    """The native surface of `arrays_of`."""
    if len(made_of) == 3:
        return _native.Surface.from_polygons(*made_of)
    return _native.Surface.from_edge_lengths(*made_of)


def given_polygons(mesh):
    """(vertices, corner_vertices, face_offsets) of a trimesh.Trimesh, meshio.Mesh, pyvista.PolyData or Open3D mesh, or
    of anything with the same attributes. @throws InvalidMesh for another object"""
    has = {"vertices", "points", "faces", "triangles", "cells", "face_offsets"} & set(dir(mesh))
    if {"vertices", "face_offsets"} <= has:
        return mesh.vertices, mesh.corner_vertices, mesh.face_offsets
    if {"vertices", "faces"} <= has:
        return np.asarray(mesh.vertices), *arrays.polygons(np.asarray(mesh.faces))
    if {"vertices", "triangles"} <= has:
        return np.asarray(mesh.vertices), *arrays.polygons(np.asarray(mesh.triangles))
    if {"points", "cells"} <= has and not isinstance(mesh.cells, np.ndarray):
        return np.asarray(mesh.points), *_of_blocks(mesh.cells)
    if {"points", "faces"} <= has:
        corners, offsets = _of_padded(arrays.integer(mesh.faces, "faces"))
        if len(strips := arrays.integer(getattr(mesh, "strips", []), "strips")):
            rows = arrays.strip_triangles(*_of_padded(strips))
            ends = offsets[-1] + np.arange(3, rows.size + 1, 3)
            corners, offsets = np.concatenate([corners, rows.ravel()]), np.concatenate([offsets, ends])
        return np.asarray(mesh.points), corners, offsets
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
