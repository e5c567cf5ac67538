# SPDX-License-Identifier: GPL-3.0-or-later
"""The elements of a mesh at which it is cut for its maps or left out of them, or for which its UV map is bad; and
selecting them."""

from dataclasses import dataclass, field

import numpy as np

from .. import compatibility
from ..compatibility import Values
from ..native import holomorph
from ..scene import mesh_io

CUT, LEFT_OUT, NO_AREA, TOUCHING, LOOSE, FLIPPED = "CUT", "LEFT_OUT", "NO_AREA", "TOUCHING", "LOOSE", "FLIPPED"
NONE = np.empty(0, np.int64)
NO_EDGES = np.empty((0, 2), np.int64)


@dataclass(frozen=True, eq=False)
class Elements:
    """Indices of vertices and faces, and edges by their vertices."""

    vertices: np.ndarray = field(default_factory=lambda: NONE)
    edges: np.ndarray = field(default_factory=lambda: NO_EDGES)
    faces: np.ndarray = field(default_factory=lambda: NONE)

    def __str__(self):
        counts = (self.vertices, "vertex", "vertices"), (self.edges, "edge", "edges"), (self.faces, "face", "faces")
        return ", ".join(f"{len(of)} {one if len(of) == 1 else many}" for of, one, many in counts if len(of))

    def __bool__(self):
        return bool(len(self.vertices) or len(self.edges) or len(self.faces))


def find(polygons, uv, kinds):
    """The `Elements` of these kinds; uv : (#C, 2), or None where there is no map."""
    vertices = [_not_finite(polygons)] * (LEFT_OUT in kinds) + [_loose(polygons)] * (LOOSE in kinds)
    edges, faces = [NO_EDGES], [NONE]
    try:
        surface = polygons.surface(strict=False)
    except (holomorph.InvalidMesh, holomorph.TopologyError):  # no face can be mapped
        faces += [np.arange(polygons.face_count)] * (LEFT_OUT in kinds and not len(vertices[0]))
    else:
        cuts = [cut for cut in surface.repairs.cuts if (TOUCHING if len(cut.vertices) else CUT) in kinds]
        vertices += [cut.vertices for cut in cuts]
        edges += [cut.edges for cut in cuts]
        faces += [cut.faces for cut in cuts] + [surface.repairs.zero_area_faces] * (NO_AREA in kinds)
        faces += [_finite(polygons, refused.faces) for refused in surface.refused] * (LEFT_OUT in kinds)
    if FLIPPED in kinds and uv is not None:
        faces.append(_flipped(polygons.face_offsets, uv))
    return Elements(np.concatenate([NONE, *vertices]), np.concatenate(edges), np.unique(np.concatenate(faces)))


def stretched(distortion, octaves, angle):
    """The faces of a `holomorph.distortion.Distortion` with a density more than `octaves` from the median, or with
    s1 / s2 above `angle`."""
    return Elements(faces=np.flatnonzero((np.abs(distortion.density) > octaves) | (distortion.angle > angle)))


def _not_finite(polygons):
    """Vertices with a coordinate that is not finite."""
    return np.flatnonzero(~np.isfinite(polygons.vertices).all(axis=1))


def _finite(polygons, faces):
    """The faces among these without a vertex of `_not_finite`."""
    at_none = np.isin(polygons.corner_vertices, _not_finite(polygons))
    face_of_corner = np.repeat(np.arange(polygons.face_count), np.diff(polygons.face_offsets))
    return np.setdiff1d(faces, face_of_corner[at_none])


def _loose(polygons):
    """Vertices of no face."""
    return np.setdiff1d(np.arange(len(polygons.vertices)), polygons.corner_vertices)


def _flipped(face_offsets, uv):
    """Faces that the map turns over beside the others, or leaves without area."""
    corners, polygon = holomorph.distortion.fans(face_offsets)
    first, second = (uv[corners[:, side]].astype(np.float64) - uv[corners[:, 0]] for side in (1, 2))
    area = np.bincount(polygon, first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0], len(face_offsets) - 1)
    return np.flatnonzero(area <= 0 if area.sum() >= 0 else area >= 0)


def select(mesh, elements):
    """Selects these elements of a mesh that is not being edited, and no others; hidden ones appear."""
    polygons = mesh_io.read_polygons(mesh, np.eye(3))
    corners = polygons.corner_vertices[polygons.has_corner_in(elements.faces)]
    vertices = np.concatenate([elements.vertices, elements.edges.ravel(), corners])
    compatibility.make_edges_selectable(mesh)
    mesh_io.mark_edges(mesh, "select", elements.edges)
    for owner, own in ((mesh.vertices, vertices), (mesh.polygons, elements.faces)):
        flags = np.zeros(len(owner), bool)
        flags[own] = True
        mesh_io.write_values(Values(owner, "select", bool), flags)
        hidden = Values(owner, "hide", bool)
        mesh_io.write_values(hidden, mesh_io.read_values(hidden) & ~flags)


def select_mode(found):
    """(vertices, edges, faces) for Blender: the simplest kind of element among `Elements`."""
    has_vertices, has_edges = any(len(e.vertices) for e in found), any(len(e.edges) for e in found)
    return has_vertices, has_edges and not has_vertices, not has_edges and not has_vertices
