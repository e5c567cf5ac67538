# SPDX-License-Identifier: GPL-3.0-or-later
"""Some of a mesh's faces, as arrays. The vertices stay those of the whole mesh: only faces and corners are counted
anew."""

from dataclasses import replace

import numpy as np

from ..native import holomorph
from . import mesh_io


def part(polygons, mask):
    """The `mesh_io.Polygons` of some of the faces, or of all of them for None."""
    if mask is None:
        return polygons
    faces = np.flatnonzero(mask).astype(np.int32)
    sizes = np.diff(polygons.face_offsets)
    offsets = np.zeros(len(faces) + 1, np.int32)
    np.cumsum(sizes[faces], out=offsets[1:])
    corners = np.flatnonzero(polygons.has_corner_in(mask)).astype(np.int32)
    loops = corners if polygons.loops is None else polygons.loops[corners]
    chosen = polygons.corner_vertices[corners]
    return replace(polygons, corner_vertices=chosen, face_offsets=offsets, loops=loops, faces=faces)


def border(mesh, polygons):
    """(n, 2) vertices of the edges between these polygons and the others of the mesh."""
    if polygons.faces is None:
        return np.empty((0, 2), np.int64)
    whole, edges = mesh_io.read_polygons(mesh, np.eye(3)), holomorph.mesh.edges
    is_own = whole.has_corner_in(polygons.faces)
    sides = edges.polygon_sides(whole)
    keys = edges.edge_keys(sides, len(whole.vertices))
    return sides[is_own & np.isin(keys, keys[~is_own])]


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
