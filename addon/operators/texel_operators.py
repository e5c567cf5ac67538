# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators for texels per metre, and the two numbers of the panel: texels, and the width of the image."""

import bpy
from bpy.props import FloatProperty, IntProperty

from .mixins import AtOnce

TEXELS, IMAGE = "holomorphic_texels", "holomorphic_image"  # properties of the window manager
TEXELS_TEXT = "Texels of the image per metre of the surface"
IMAGE_TEXT = "Width of the image in texels"
DEFAULT_IMAGE = 2048


class _TexelOperator(AtOnce):
    """A mixin: on the active UV maps of the selected meshes, in edit mode on their selected faces."""

    image: IntProperty(name="Image", description=IMAGE_TEXT, default=DEFAULT_IMAGE, min=1)

    def invoke(self, context, _event):
        for name, stored in (("texels", TEXELS), ("image", IMAGE)):
            if name in self.properties.bl_rna.properties and not self.properties.is_property_set(name):
                setattr(self, name, getattr(context.window_manager, stored))
        return self.execute(context)

    def read(self, _context, objects):
        from ..scene import targets
        from ..solving.jobs import SELECTED

        self._found = targets.collect(objects, faces=SELECTED)
        return targets.objects(self._found)

    def act(self, step, _objects):
        from ..results import heat

        metres = step.context.scene.unit_settings.scale_length
        done = 0
        for target in self._found:
            problem = heat.why_no_texels(target)
            before = 0.0 if problem else heat.texels(target, self.image, metres)
            if before > 0:
                self.treat(step.context, target, before)
                done += 1
            else:
                self.report({"WARNING"}, f"{target.name}: {problem or 'its UV map has no area'}")
        return done > 0


class HOLOMORPH_OT_texels_get(_TexelOperator, bpy.types.Operator):
    """Measure the texels per metre of the active UV maps of the selected meshes, in edit mode of the selected faces.
    Set takes over the value of the active object"""

    bl_idname = "uv.holomorphic_texels_get"
    bl_label = "Get Texels per Metre"

    def treat(self, context, target, before):
        self.report({"INFO"}, f"{target.name}: {before:.5g} texels per metre")
        if target.find() == context.view_layer.objects.active:
            setattr(context.window_manager, TEXELS, before)


class HOLOMORPH_OT_texels_set(_TexelOperator, bpy.types.Operator):
    """Scale the active UV maps of the selected meshes, in edit mode the selected faces, to this number of texels per
    metre, each map as a whole. Seamless tilings are scaled by whole numbers only, so that they stay seamless"""

    bl_idname = "uv.holomorphic_texels_set"
    bl_label = "Set Texels per Metre"

    texels: FloatProperty(name="Texels", description=TEXELS_TEXT, default=512.0, min=1e-3)

    def treat(self, _context, target, before):
        from ..results import heat

        factor = heat.scale_texels(target, self.texels / before)
        if not heat.is_met(self.texels, factor, before):
            nearest = f"{before * factor:.5g} texels per metre, the nearest that stays seamless"
            self.report({"INFO"}, f"{target.name}: {nearest}; Tiles also changes them")


_register, _unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_texels_get, HOLOMORPH_OT_texels_set])


def register():
    _register()
    manager = bpy.types.WindowManager
    setattr(manager, TEXELS, FloatProperty(name="Texels / m", description=TEXELS_TEXT, default=512.0, min=1e-3))
    setattr(manager, IMAGE, IntProperty(name="Image", description=IMAGE_TEXT, default=DEFAULT_IMAGE, min=1))


def unregister():
    for name in (IMAGE, TEXELS):
        delattr(bpy.types.WindowManager, name)
    _unregister()
