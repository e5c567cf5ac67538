# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made for an object: tags that tell whose it is, empties at poles, the result of its modifiers.

The next run replaces what the tags find. A tag names the object, and the data-block as it was made. A copy of the
data-block has another name, and is the artist's.
"""

import bpy
import numpy as np

from .. import compatibility
from ..scene import mesh_io
from . import report

MADE_AS = "holomorph_made_as"  # custom property of what is made: its name and its mesh's, and the object's mesh's


def put(made, key, obj):
    """Tags a data-block, which has its final name, as made for an object; `key` is the kind, a custom property."""
    made[key], made[MADE_AS] = obj.name, _names(made, obj)


def find(key, obj, among=None):
    """Finds the data-blocks made for an object, by default among all objects of this file."""
    blocks = bpy.data.objects if among is None else among
    own = [made for made in blocks if made.library is None and made.get(key) == obj.name]
    return [made for made in own if made.get(MADE_AS) == _names(made, obj)]


def _names(made, obj):
    return "\n".join([made.name, getattr(getattr(made, "data", None), "name", ""), obj.data.name])


EMPTY_OF = "holomorph_mark_of"  # custom property: name of the object whose pole or branch point it is
EMPTY_SIZE = 0.02  # part of the object's largest extent


def write_empties(context, obj, vertices, is_pole):
    """Adds one empty, a child of the object, at each of these vertices. @pre those of an earlier run are to be
    removed"""
    points = mesh_io.world_points(obj)
    size = EMPTY_SIZE * float(np.ptp(points, axis=0).max())
    context.view_layer.update()
    for vertex, pole in zip(vertices.tolist(), is_pole.tolist()):
        empty = bpy.data.objects.new(f"{obj.name} {'Pole' if pole else 'Branch Point'}", None)
        put(empty, EMPTY_OF, obj)
        empty.empty_display_type = "SPHERE" if pole else "PLAIN_AXES"
        empty.empty_display_size = size
        for collection in obj.users_collection:
            collection.objects.link(empty)
        empty.parent = obj
        empty.matrix_parent_inverse = obj.matrix_world.inverted_safe()
        empty.location = points[vertex]


def empties_of(obj):
    """The empties of an earlier run."""
    return [made for made in find(EMPTY_OF, obj) if made.type == "EMPTY"]


RESULT_OF = "holomorph_mapped_of"  # custom property of the result of modifiers: name of the object that has these


def modifier_result(step, obj):
    """A new object with the mesh that the modifiers of `obj` make, in place of that of an earlier run; it is selected
    instead of `obj`, which is hidden, so that nothing is lost."""
    step.remove(find(RESULT_OF, obj))
    context = step.context
    shown = context.evaluated_depsgraph_get()
    mesh = bpy.data.meshes.new_from_object(obj.evaluated_get(shown), preserve_all_data_layers=True, depsgraph=shown)
    made = obj.copy()
    made.modifiers.clear()
    made.data = mesh
    made.name = mesh.name = f"{obj.name} Mapped"
    report.remove(made)
    put(made, RESULT_OF, obj)
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
