# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene of its own in which copies of objects are baked, so that the file stays as it is; it is gone in the end."""

from contextlib import ExitStack, contextmanager

import bpy

from .. import compatibility
from ..materials import material as shown
from ..writing import transaction
from . import images
from .channels import HEIGHT, NORMAL, ChannelCopy, check

FLAT = (0.5, 0.5, 1.0, 1.0)  # a normal that stands upright
BLACK = (0.0, 0.0, 0.0, 1.0)


@contextmanager
def bake_scene():
    """Gives the `BakeScene`."""
    made = []
    with ExitStack() as in_the_end:
        in_the_end.callback(clear, made)
        yield BakeScene(made)


def clear(made):
    transaction.remove(made)


class BakeScene:
    """made : the list to which data-blocks are added in the line that makes them"""

    def __init__(self, made):
        made.append(bpy.data.scenes.new("Holomorph Bake"))
        (self._scene,), self._made, self._materials = made, made, {}
        self._scene.render.engine = "CYCLES"
        settings = self._scene.cycles
        settings.device, settings.samples = "CPU", 1  # the first sample is in the middle of a texel
        settings.use_denoising = settings.use_adaptive_sampling = False

    def add(self, obj):
        """A copy of an object with a copy of its mesh, whose materials give off channels. @throws ValueError"""
        self._made.append(obj.data.copy())
        self._made.append(obj.copy())
        mesh, copy = self._made[-2:]
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
                self._made.append(bpy.data.materials.new("Holomorph Bake"))
                source = _made_plain(self._made[-1], material)
            check(source)
            self._made.append(source.copy())
            self._materials[material] = ChannelCopy(self._made[-1])
        return self._materials[material]

    def new_image(self, channel, side):
        has_floats = channel == HEIGHT
        self._made.append(bpy.data.images.new("Holomorph Bake", side, side, alpha=False, float_buffer=has_floats))
        image = self._made[-1]
        image.colorspace_settings.name = images.colour_space(channel)
        image.generated_color = FLAT if channel == NORMAL else BLACK
        return image

    def bake(self, copy, map_name, channel, image, margin):
        """@throws RuntimeError Blender cannot"""
        for material in self._materials.values():
            material.show(channel, image)
        layer = self._scene.view_layers[0]
        layer.update()
        for obj in compatibility.objects_in(layer):
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


def _made_plain(made, material):
    """Gives a new material nodes, for one without, or for none, and returns it."""
    tree = compatibility.enable_nodes(made)
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    if material is not None:
        shader.inputs["Base Color"].default_value = material.diffuse_color
        shader.inputs["Roughness"].default_value = material.roughness
        shader.inputs["Metallic"].default_value = material.metallic
    return made
