# SPDX-License-Identifier: GPL-3.0-or-later
"""Some of a mesh's faces, as arrays. The vertices stay those of the whole mesh: only faces and corners are counted
anew."""

from dataclasses import replace

import numpy as np

from . import mesh_io


def part(polygons, mask):
    """The `mesh_io.Polygons` of some of the faces, or of all of them for None."""
    if mask is None:
        return polygons
    faces = np.flatnonzero(mask).astype(np.int32)
    sizes = np.diff(polygons.face_offsets)
    offsets = np.zeros(len(faces) + 1, np.int32)
    np.cumsum(sizes[faces], out=offsets[1:])
    corners = np.flatnonzero(np.repeat(mask, sizes)).astype(np.int32)
    loops = corners if polygons.loops is None else polygons.loops[corners]
    chosen = polygons.corner_vertices[corners]
    return replace(polygons, corner_vertices=chosen, face_offsets=offsets, loops=loops, faces=faces)


def edge_ends(polygons):
    """(#C, 2) vertices of the edge from each corner to the next one of its face, lower vertex first."""
    following = np.arange(1, len(polygons.corner_vertices) + 1)
    following[polygons.face_offsets[1:] - 1] = polygons.face_offsets[:-1]
    corners = polygons.corner_vertices.astype(np.int64)
    return np.sort(np.stack([corners, corners[following]], axis=1), axis=1)


def border(mesh, polygons):
    """(n, 2) vertices of the edges between these polygons and the others of the mesh."""
    if polygons.faces is None:
        return np.empty((0, 2), np.int64)
    whole = mesh_io.read_polygons(mesh, np.eye(3))
    ends, is_own = edge_ends(whole), np.zeros(whole.face_count, bool)
    is_own[polygons.faces] = True
    of_own = np.repeat(is_own, np.diff(whole.face_offsets))
    key = ends[:, 0] * len(whole.vertices) + ends[:, 1]
    return ends[of_own & np.isin(key, key[~of_own])]


def repairs(solved):
    """The repairs of a `solve.SolvedObject`, with faces as the mesh counts them; vertices of other faces are not
    isolated."""
    found, faces = solved.surface.repairs, solved.polygons.faces
    if faces is None:
        return found
    none = np.empty(0, np.int64)
    of_mesh = {name: faces[getattr(found, name)] for name in ("reversed_faces", "zero_area_faces")}
    cuts = tuple(replace(cut, faces=faces[cut.faces]) for cut in found.cuts)
    return replace(found, isolated_vertices=none, cuts=cuts, **of_mesh)
