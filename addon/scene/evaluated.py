# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as their objects' modifiers and shape keys make them, to be mapped where this is asked for."""

import bpy
import numpy as np

from . import mesh_edges, mesh_io


def read(obj, linear):
    """(`mesh_io.Polygons`, (n, 2) vertices of the seams) of an object with its modifiers as the viewport shows them."""
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = shown.to_mesh()
    try:
        return mesh_io.read_polygons(mesh, linear), mesh_edges.marked_edges(mesh, "use_seam")
    finally:
        shown.to_mesh_clear()


def are_those_of(shown, own):
    """Whether the polygons are those of the mesh itself, which modifiers have moved at most."""
    same = np.array_equal(shown.face_offsets, own.face_offsets)
    return same and np.array_equal(shown.corner_vertices, own.corner_vertices)


def first_of(obj):
    """The name of the first modifier that is shown, in quotes, or ""."""
    return next((repr(m.name) for m in obj.modifiers if m.show_viewport), "")
