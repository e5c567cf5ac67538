# SPDX-License-Identifier: GPL-3.0-or-later
"""Tags that tell whose a data-block is: what is made for an object is replaced by the next run.

A tag names the object, and the data-block as it was made. A copy of the data-block has another name, and is the
artist's.
"""

import bpy

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
