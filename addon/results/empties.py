# SPDX-License-Identifier: GPL-3.0-or-later
"""Poles and branch points of a tiling as empties: children of the object, in its collections."""

import bpy
import numpy as np

from ..scene import mesh_io
from . import tags

OF = "holomorph_mark_of"  # custom property: name of the object whose pole or branch point it is
SIZE = 0.02  # part of the object's largest extent


def write(context, obj, vertices, is_pole):
    """Adds one empty at each of these vertices. @pre the empties of an earlier run are to be removed"""
    points = mesh_io.world_points(obj)
    size = SIZE * float(np.ptp(points, axis=0).max())
    context.view_layer.update()
    for vertex, pole in zip(vertices.tolist(), is_pole.tolist()):
        empty = bpy.data.objects.new(f"{obj.name} {'Pole' if pole else 'Branch Point'}", None)
        tags.put(empty, OF, obj)
        empty.empty_display_type = "SPHERE" if pole else "PLAIN_AXES"
        empty.empty_display_size = size
        for collection in obj.users_collection:
            collection.objects.link(empty)
        empty.parent = obj
        empty.matrix_parent_inverse = obj.matrix_world.inverted_safe()
        empty.location = points[vertex]


def of(obj):
    """The empties of an earlier run."""
    return [made for made in tags.find(OF, obj) if made.type == "EMPTY"]
