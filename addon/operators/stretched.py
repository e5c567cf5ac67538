# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that selects the faces on which a texture is too large, too small or sheared."""

import math

import bpy
from bpy.props import FloatProperty

from .mixins import AtOnce
from .tools import edit


class HOLOMORPH_OT_select_stretched(AtOnce, bpy.types.Operator):
    """Go to edit mode and select the faces on which the active UV map of the selected meshes makes a texture too large,
    too small or sheared"""

    bl_idname = "mesh.holomorphic_select_stretched"
    bl_label = "Select Stretched Faces"
    nothing = "No face is stretched that much"

    size: FloatProperty(
        name="Size",
        description="Faces whose squares are longer or shorter than the median by this factor",
        default=2.0,
        min=1.0,
        soft_max=10.0,
    )
    angle: FloatProperty(
        name="Angle Distortion",
        description="Faces whose squares are longer than wide by this factor",
        default=2.0,
        min=1.0,
        soft_max=10.0,
    )

    def draw(self, _context):
        self.layout.prop(self, "size")
        self.layout.prop(self, "angle")

    def read(self, context, objects):
        self._is_editing = context.mode == "EDIT_MESH"
        return objects

    def act(self, step, objects):
        from ..results import bad, heat

        found = {obj: self._elements(obj) for obj in objects if heat.is_possible(obj)}
        if not any(found.values()):
            return False
        for obj, elements in found.items():
            bad.select(obj.data, elements)
        step.context.scene.tool_settings.mesh_select_mode = bad.select_mode([e for e in found.values() if e])
        if not self._is_editing:
            edit(step.context, [obj for obj, elements in found.items() if elements])
        return True

    def _elements(self, obj):
        """The stretched faces as `bad.Elements`."""
        from ..results import bad, heat

        _, distortion = heat.measured(obj.data, obj.matrix_world.to_3x3())
        elements = bad.stretched(distortion, 2 * math.log2(self.size), self.angle)
        if elements:
            self.report({"INFO"}, f"{obj.name}: {elements}")
        return elements


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_select_stretched])
