# SPDX-License-Identifier: GPL-3.0-or-later
"""Our materials as files of other programs can hold them: one image, laid on by the map as it is."""

import bpy

from . import material, nodes


def show(obj):
    """Puts plain materials into the slots that ours cover, where they show one of the mesh's UV maps."""
    for slot in obj.material_slots:
        if material.is_ours(slot.material) and nodes.shown_map(slot.material) in obj.data.uv_layers:
            slot.material = _plain(slot.material)


def _plain(shown):
    """The material with the image and the roughness of one of ours; made once."""
    name = f"{shown.name} Image"
    found = bpy.data.materials.get((name, None))
    if found is None:
        found = bpy.data.materials.new(name)
        nodes.build_plain(found, shown)
    return found
