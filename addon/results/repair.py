# SPDX-License-Identifier: GPL-3.0-or-later
"""Repairing a mesh, so that its maps need no cuts: vertices are welded, superfluous elements removed."""

from dataclasses import dataclass

import bmesh
import numpy as np

WELD, DOUBLES, INSIDE, LOOSE = "WELD", "DOUBLES", "INSIDE", "LOOSE"


@dataclass(frozen=True)
class Repaired:
    """How many elements are gone."""

    welded: int = 0
    doubles: int = 0
    inside: int = 0
    loose_vertices: int = 0
    loose_edges: int = 0

    def __bool__(self):
        return any(vars(self).values())

    def __str__(self):
        done = (
            ("welded", self.welded, "vertex", "vertices"),
            ("removed", self.doubles, "face that stood twice", "faces that stood twice"),
            ("removed", self.inside, "inside face", "inside faces"),
            ("removed", self.loose_vertices, "loose vertex", "loose vertices"),
            ("removed", self.loose_edges, "loose edge", "loose edges"),
        )
        return ", ".join(f"{verb} {n} {one if n == 1 else many}" for verb, n, one, many in done if n)


def repair(mesh, kinds, distance):
    """Repairs a mesh with faces that is in no edit mode; returns the `Repaired`.

    What stays keeps its UV maps, attributes, shape keys and materials.
    kinds : some of WELD, DOUBLES, INSIDE, LOOSE
    distance : below which vertices are welded, in the mesh's own units
    """
    edited = bmesh.new()
    try:
        edited.from_mesh(mesh)
        done = Repaired(
            welded=_weld(edited, distance) if WELD in kinds else 0,
            doubles=_remove_faces(edited, _doubles) if DOUBLES in kinds else 0,
            inside=_remove_faces(edited, _inside) if INSIDE in kinds else 0,
            loose_vertices=_remove_loose(edited, edited.verts, "VERTS") if LOOSE in kinds else 0,
            loose_edges=_remove_loose(edited, edited.edges, "EDGES") if LOOSE in kinds else 0,
        )
        if done:
            edited.to_mesh(mesh)
            mesh.update()
        return done
    finally:
        edited.free()


def _weld(edited, distance):
    before = len(edited.verts)
    finite = [v for v in edited.verts if all(np.isfinite(v.co))]  # a search among NaNs finds anything
    bmesh.ops.remove_doubles(edited, verts=finite, dist=distance)
    return before - len(edited.verts)


def _remove_faces(edited, chosen):
    """Removes the faces that `chosen` gives for the mesh, and edges and vertices that only they had."""
    found = list(chosen(edited))
    bmesh.ops.delete(edited, geom=found, context="FACES")
    return len(found)


def _doubles(edited):
    """Faces with the vertices of an earlier one."""
    seen = set()
    for face in edited.faces:
        vertices = frozenset(face.verts)
        if vertices in seen:
            yield face
        seen.add(vertices)


def _inside(edited):
    """Faces of which each edge has three faces or more: what "Select Interior Faces" of Blender selects."""
    return (face for face in edited.faces if all(len(edge.link_faces) > 2 for edge in face.edges))


def _remove_loose(edited, elements, context):
    """Removes the vertices or edges of no face."""
    found = [element for element in elements if not element.link_faces]
    bmesh.ops.delete(edited, geom=found, context=context)
    return len(found)
