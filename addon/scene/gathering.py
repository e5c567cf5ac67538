# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that an operator is about: those that are edited, painted or selected; and whether it can change them."""

import bpy
import numpy as np

from .. import compatibility
from . import mesh_io

SAME_SCALE = 1e-5  # relative: matrices of objects are float32
IMPORTER_HELPERS = "glTF_not_exported"  # the collection of the glTF importer


def mesh_objects(context):
    """The mesh objects the operator is about, the active one first."""
    active = context.view_layer.objects.active
    return sorted(candidates(context), key=lambda o: o != active)


def candidates(context):
    """The objects that are edited, the one that is sculpted or painted, or in object mode those that are selected."""
    if context.mode == "OBJECT":
        return selected_meshes(context)
    return compatibility.objects_being_edited(context) if context.mode == "EDIT_MESH" else [context.object]


def has_candidates(context):
    """Whether there are any; a panel asks it whenever it is drawn."""
    return any(True for _ in candidates(context))


def selected_meshes(context):
    """Yields the selected mesh objects that are visible, in a 3D view those of its local view."""
    selected = compatibility.selected_in(context.view_layer)
    return (o for o in selected if o.type == "MESH" and o.visible_get() and not is_helper(o))


def is_helper(obj):
    """Whether Blender's importer made it for its own use, such as the shapes of bones. It is not part of the scene."""
    return any(collection.name.startswith(IMPORTER_HELPERS) for collection in obj.users_collection)


def why_fixed(obj):
    """Why the mesh of an object cannot be changed, one sentence, or ""."""
    mesh = obj.data
    if mesh.library is not None:
        return "its mesh is linked from another file; make it local first"
    if mesh.override_library is not None:
        return "its mesh is a library override, which cannot keep UV maps; make it local first"
    shown = compatibility.objects_in(bpy.context.view_layer)
    if mesh.is_editmode and not any(other.mode == "EDIT" and other.data == mesh for other in shown):
        return "its mesh is edited in another scene or view layer; leave edit mode there first"
    return ""


def others(obj):
    """The further objects with its mesh that can be changed."""
    if obj.data.users < 2:
        return []
    return [other for other in bpy.data.objects if other.data == obj.data and other != obj and other.library is None]


def has_other_scale(obj, other):
    """Whether their matrices differ by more than rotation, reflection or a factor."""
    return not np.allclose(_metric(obj), _metric(other), rtol=0, atol=SAME_SCALE)


def _metric(obj):
    """How the object's matrix changes shapes: equal for matrices that differ by rotation, reflection or factor."""
    metric = mesh_io.linear(obj).T @ mesh_io.linear(obj)
    size = np.trace(metric)
    return metric / size if size > 0 else metric
