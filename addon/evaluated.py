# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as their objects' modifiers and shape keys make them, to be mapped where this is asked for.

Where only vertices are moved, the maps go to the object's own mesh. Else the result of the modifiers becomes an object
of its own in the object's place, and the object is hidden, so that nothing is lost.
"""

import bpy
import numpy as np

from . import mesh_edges, mesh_io, report

OF = "holomorph_mapped_of"  # custom property of such an object: name of the one whose modifiers made it


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


def as_object(context, obj):
    """A new object with the mesh that the modifiers of `obj` make, in place of that of an earlier run; it is selected
    instead of `obj`, which is hidden."""
    _remove_earlier(obj)
    shown = context.evaluated_depsgraph_get()
    mesh = bpy.data.meshes.new_from_object(obj.evaluated_get(shown), preserve_all_data_layers=True, depsgraph=shown)
    made = obj.copy()
    made.modifiers.clear()
    made.data = mesh
    made.name = mesh.name = f"{obj.name} Mapped"
    made.pop(report.PROPERTY, None)
    made[OF] = obj.name
    collections = [c for c in obj.users_collection if c.library is None] or [context.scene.collection]
    for collection in collections:
        collection.objects.link(made)
    context.view_layer.update()
    _show_instead(context, made, obj)
    return made


def _remove_earlier(obj):
    for old in [o for o in bpy.data.objects if o.library is None and o.get(OF) == obj.name and o != obj]:
        mesh = old.data
        bpy.data.objects.remove(old)
        if mesh.users == 0:
            bpy.data.meshes.remove(mesh)


def _show_instead(context, made, obj):
    if made.name in context.view_layer.objects:
        made.select_set(True)
        context.view_layer.objects.active = made
    obj.select_set(False)
    obj.hide_set(True)
    obj.hide_render = True
