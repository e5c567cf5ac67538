# SPDX-License-Identifier: GPL-3.0-or-later
"""Repairing a mesh, so that its maps need no cuts: vertices are welded, superfluous elements removed."""

from contextlib import contextmanager
from dataclasses import dataclass

import bmesh
import numpy as np

from .. import compatibility
from ..scene import mesh_io

WELD, DOUBLES, INSIDE, SLIVERS, LOOSE = "WELD", "DOUBLES", "INSIDE", "SLIVERS", "LOOSE"
LOW, ROUNDING = 1e-4, 2.0**-20  # most heights of slivers, over their longest sides and over their coordinates


@dataclass(frozen=True)
class Repaired:
    """How many elements are gone."""

    welded: int = 0
    doubles: int = 0
    inside: int = 0
    slivers: int = 0
    loose_vertices: int = 0
    loose_edges: int = 0

    def __bool__(self):
        return any(vars(self).values())

    def __str__(self):
        done = (
            ("welded", self.welded, "vertex", "vertices"),
            ("removed", self.doubles, "duplicate face", "duplicate faces"),
            ("removed", self.inside, "inside face", "inside faces"),
            ("merged", self.slivers, "sliver", "slivers"),
            ("removed", self.loose_vertices, "loose vertex", "loose vertices"),
            ("removed", self.loose_edges, "loose edge", "loose edges"),
        )
        return ", ".join(f"{verb} {n} {one if n == 1 else many}" for verb, n, one, many in done if n)


def repair(mesh, kinds, distance):
    """Repairs a mesh with faces that is in no edit mode; returns the `Repaired`.

    What stays keeps its UV maps, attributes, shape keys and materials.
    kinds : some of WELD, DOUBLES, INSIDE, SLIVERS, LOOSE
    distance : below which vertices are welded, in the mesh's own units
    """
    return Repaired(
        welded=_weld(mesh, distance) if WELD in kinds else 0,
        doubles=_remove(mesh, "faces", _doubles(mesh)) if DOUBLES in kinds else 0,
        inside=_remove(mesh, "faces", _inside(mesh)) if INSIDE in kinds else 0,
        slivers=_merge_slivers(mesh) if SLIVERS in kinds else 0,
        loose_vertices=_remove(mesh, "verts", _loose_vertices(mesh)) if LOOSE in kinds else 0,
        loose_edges=_remove(mesh, "edges", _loose_edges(mesh)) if LOOSE in kinds else 0,
    )


@contextmanager
def _edited(mesh):
    """Gives a BMesh of the mesh; writes it back if elements are gone."""
    edited = bmesh.new()
    try:
        edited.from_mesh(mesh)
        before = _counts(edited)
        yield edited
        if _counts(edited) != before:
            edited.to_mesh(mesh)
            mesh.update()
    finally:
        edited.free()


def _counts(edited):
    return len(edited.verts), len(edited.edges), len(edited.faces)


def _weld(mesh, distance):
    positions = mesh_io.read_values(compatibility.position_values(mesh))
    is_finite = np.isfinite(positions).all(axis=1)  # a search among NaNs finds anything
    with _edited(mesh) as edited:
        edited.verts.ensure_lookup_table()
        finite = edited.verts[:] if is_finite.all() else [edited.verts[i] for i in np.flatnonzero(is_finite)]
        bmesh.ops.remove_doubles(edited, verts=finite, dist=distance)
    return len(positions) - len(mesh.vertices)


def _remove(mesh, kind, found):
    """Removes elements by their indices; of faces also the edges and vertices that only they had."""
    if len(found):
        with _edited(mesh) as edited:
            elements = getattr(edited, kind)
            elements.ensure_lookup_table()
            bmesh.ops.delete(edited, geom=[elements[i] for i in found.tolist()], context=kind.upper())
    return len(found)


def _doubles(mesh):
    """Faces with the vertices of an earlier one."""
    polygons, found = mesh_io.read_polygons(mesh, np.eye(3)), []
    sizes = np.diff(polygons.face_offsets)
    for size in np.unique(sizes):
        faces = np.flatnonzero(sizes == size)
        corners = polygons.corner_vertices[polygons.face_offsets[faces][:, None] + np.arange(size)]
        _, first = np.unique(np.sort(corners, axis=1), axis=0, return_index=True)
        found.append(np.delete(faces, first))
    return np.sort(np.concatenate(found))


def _inside(mesh):
    """Faces of which each edge has three faces or more: what "Select Interior Faces" of Blender selects."""
    polygons = mesh_io.read_polygons(mesh, np.eye(3))
    edges = polygons.of_corners(_edges_of_loops(mesh))
    has_many = np.bincount(edges)[edges] > 2
    return np.flatnonzero(np.logical_and.reduceat(has_many, polygons.face_offsets[:-1]))


def _slivers(mesh):
    """Faces without area, up to the rounding of their coordinates."""
    polygons = mesh_io.read_polygons(mesh, np.eye(3))
    starts, ends = polygons.face_offsets[:-1], polygons.face_offsets[1:]
    following = np.arange(1, len(polygons.corner_vertices) + 1)
    following[ends - 1] = starts
    points = polygons.vertices[polygons.corner_vertices]
    sides = points[following] - points
    fans = np.cross(points - np.repeat(points[starts], ends - starts, axis=0), sides)  # twice their areas
    longest, area, size = (
        np.maximum.reduceat(values, starts)
        for values in (np.linalg.norm(sides, axis=1), np.linalg.norm(fans, axis=1), np.abs(points).max(axis=1))
    )
    return np.flatnonzero(area <= longest * np.minimum(LOW * longest, ROUNDING * size))


def _merge_slivers(mesh):
    """Joins each with the face at its longest side, which takes over its other corners; nothing moves."""
    found, merged = _slivers(mesh), 0
    with _edited(mesh) as edited:
        edited.faces.ensure_lookup_table()
        for face in edited.faces:
            face.tag = False
        open_slivers = [edited.faces[i] for i in found.tolist()]
        for face in open_slivers:
            face.tag = True
        while open_slivers:
            face = open_slivers.pop()
            made = _joined(face) if face.is_valid else None
            merged += made is not None
            if made is not None and made.tag:
                open_slivers.append(made)
    return merged


def _joined(sliver):
    """The face that a sliver and another are joined to, a sliver where both were; None where that cannot be."""
    inner = [edge for edge in sliver.edges if len(edge.link_faces) == 2 and edge.link_faces[0] != edge.link_faces[1]]
    for edge in sorted(inner, key=lambda edge: -edge.calc_length()):
        other = next(face for face in edge.link_faces if face != sliver)
        starts = {loop.vert for loop in edge.link_loops}
        if len(starts) == 1:  # they run against each other
            sliver.normal_flip()
        is_sliver = other.tag
        made = bmesh.utils.face_join([other, sliver])  # with what belongs to the first
        if made is not None:
            made.tag = is_sliver
            return made
    return None


def _loose_vertices(mesh):
    used = mesh_io.read_polygons(mesh, np.eye(3)).corner_vertices
    return np.flatnonzero(np.bincount(used, minlength=len(mesh.vertices)) == 0)


def _loose_edges(mesh):
    return np.flatnonzero(np.bincount(_edges_of_loops(mesh), minlength=len(mesh.edges)) == 0)


def _edges_of_loops(mesh):
    return mesh_io.read_values(compatibility.Values(mesh.loops, "edge_index", np.uint32)).astype(np.int64)
