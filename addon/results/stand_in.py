# SPDX-License-Identifier: GPL-3.0-or-later
"""What an object's modifiers make, as an object of its own: where they change its faces, it takes the maps, and the
object is hidden, so that nothing is lost."""

import bpy

from .. import compatibility
from . import report, tags

OF = "holomorph_mapped_of"  # custom property of such an object: name of the one whose modifiers made it


def make(step, obj):
    """A new object with the mesh that the modifiers of `obj` make, in place of that of an earlier run; it is selected
    instead of `obj`, which is hidden."""
    step.remove(tags.find(OF, obj))
    context = step.context
    shown = context.evaluated_depsgraph_get()
    mesh = bpy.data.meshes.new_from_object(obj.evaluated_get(shown), preserve_all_data_layers=True, depsgraph=shown)
    made = obj.copy()
    made.modifiers.clear()
    made.data = mesh
    made.name = mesh.name = f"{obj.name} Mapped"
    made.pop(report.PROPERTY, None)
    tags.put(made, OF, obj)
    collections = [c for c in obj.users_collection if c.library is None] or [context.scene.collection]
    for collection in collections:
        collection.objects.link(made)
    context.view_layer.update()
    _show_instead(context, made, obj)
    return made


def _show_instead(context, made, obj):
    if made in compatibility.objects_in(context.view_layer):
        made.select_set(True)
        context.view_layer.objects.active = made
    obj.select_set(False)
    obj.hide_set(True)
    obj.hide_render = True
