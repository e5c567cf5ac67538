# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene of its own in which copies of objects are baked, so that the file stays as it is; it is gone in the end."""

from contextlib import contextmanager

import bpy

from .. import compatibility
from ..materials import material as shown
from ..writing import transaction
from . import images
from .channels import ChannelCopy
from .options import HEIGHT, NORMAL

FLAT = (0.5, 0.5, 1.0, 1.0)  # a normal that stands upright
BLACK = (0.0, 0.0, 0.0, 1.0)


@contextmanager
def room():
    """Gives the `Room`."""
    made = Room()
    try:
        yield made
    finally:
        made.clear()


class Room:
    def __init__(self):
        self._scene = bpy.data.scenes.new("Holomorph Bake")
        self._made, self._materials = [self._scene], {}
        self._scene.render.engine = "CYCLES"
        settings = self._scene.cycles
        settings.device, settings.samples = "CPU", 1  # the first sample is in the middle of a texel
        settings.use_denoising = settings.use_adaptive_sampling = False

    def clear(self):
        transaction.remove(self._made)

    def add(self, obj, mesh):
        """A copy of an object with a copy of its mesh, whose materials give off channels. @throws ValueError"""
        self._made.append(mesh)
        copy = obj.copy()
        self._made.append(copy)
        copy.data = mesh
        for slot, own in zip(copy.material_slots, shown.before_bake(obj)):
            slot.link = "OBJECT"
            slot.material = self._copied(own).block
        copy.hide_render = copy.hide_viewport = False
        self._scene.collection.objects.link(copy)
        return copy

    def _copied(self, material):
        """The `ChannelCopy` of a material, or of a grey one for none."""
        if material not in self._materials:
            source = material
            if material is None or material.node_tree is None:
                source = _plain(material)
                self._made.append(source)
            self._materials[material] = ChannelCopy(source)
            self._made.append(self._materials[material].block)
        return self._materials[material]

    def new_image(self, channel, side):
        image = bpy.data.images.new("Holomorph Bake", side, side, alpha=False, float_buffer=channel == HEIGHT)
        self._made.append(image)
        image.colorspace_settings.name = images.colour_space(channel)
        image.generated_color = FLAT if channel == NORMAL else BLACK
        return image

    def bake(self, copy, map_name, channel, image, margin):
        """@throws RuntimeError Blender cannot"""
        for material in self._materials.values():
            material.show(channel, image)
        layer = self._scene.view_layers[0]
        layer.update()
        for obj in layer.objects:
            obj.select_set(obj == copy, view_layer=layer)
        layer.objects.active = copy
        objects = {"active_object": copy, "object": copy, "selected_objects": [copy]}
        with bpy.context.temp_override(scene=self._scene, view_layer=layer, **objects):
            bpy.ops.object.bake(
                type="NORMAL" if channel == NORMAL else "EMIT",
                normal_space="TANGENT",
                uv_layer=map_name,
                margin=margin,
                margin_type="EXTEND",  # the other kind reads faces beside, and beyond them other islands
                use_clear=False,
            )


def _plain(material):
    """A material with nodes for one without, or for none."""
    made = bpy.data.materials.new("Holomorph Bake")
    tree = compatibility.enable_nodes(made)
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    if material is not None:
        shader.inputs["Base Color"].default_value = material.diffuse_color
        shader.inputs["Roughness"].default_value = material.roughness
        shader.inputs["Metallic"].default_value = material.metallic
    return made
