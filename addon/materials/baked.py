# SPDX-License-Identifier: GPL-3.0-or-later
"""A material that shows baked images by the map that they were baked with."""

import bpy

from . import material, nodes

ROWS = 300  # distance of image nodes, in the editor's units
ROUGHNESS = 0.5  # where none is baked
INPUTS = {"COLOUR": "Base Color", "ROUGHNESS": "Roughness", "METALLIC": "Metallic"}  # others have nodes of their own


def build(name, map_name, images):
    """A new material; images by channel. A height stands beside the others, linked to nothing."""
    made = bpy.data.materials.new(name)
    made[material.OURS] = True
    tree = nodes.Tree.of(made)
    vector, shader = tree.map_vector(map_name, is_attribute=False), tree.shader(ROUGHNESS)
    for row, (channel, image) in enumerate(images.items()):
        picture = tree.node("ShaderNodeTexImage", -600, 400 - ROWS * row, channel.title(), image=image)
        tree.link(vector, picture.inputs["Vector"])
        if channel in INPUTS:
            tree.link(picture.outputs[0], shader.inputs[INPUTS[channel]])
        elif channel == "NORMAL":
            turned = tree.node("ShaderNodeNormalMap", -300, 400 - ROWS * row, uv_map=map_name)
            tree.link(picture.outputs[0], turned.inputs["Color"])
            tree.link(turned.outputs[0], shader.inputs["Normal"])
        if row == 0:
            tree.show_in_solid_view(picture)
    return made
