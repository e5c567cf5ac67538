# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panels have besides the two buttons and the result: the sub-panel "Tools"."""

import bpy

from ..operators import submit, texel_operators
from ..operators.carry import HOLOMORPH_OT_carry
from ..operators.compare import HOLOMORPH_OT_compare
from ..operators.mapping import HOLOMORPH_OT_maps
from ..operators.tools import HOLOMORPH_OT_remove_maps, HOLOMORPH_OT_select_bad
from . import lines


def draw_modifiers(layout, context, obj):
    """The button again, for an object whose modifiers change its shape."""
    from ..scene import targets

    if targets.first_modifier(obj):
        if not len(obj.data.polygons):
            lines.draw(layout, context, "Only its modifiers make faces", "INFO")
        layout.operator(HOLOMORPH_OT_maps.bl_idname, text="Map with Modifiers", icon="MODIFIER").modifiers = True


class _ToolsPanel:
    bl_label = "Tools"
    bl_category = "Holomorph"
    bl_region_type = "UI"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        _draw_texels(self.layout, context.window_manager)
        column = self.layout.column(align=True)
        column.operator(HOLOMORPH_OT_select_bad.bl_idname)
        column.operator(HOLOMORPH_OT_remove_maps.bl_idname)
        submit.draw(column)


class HOLOMORPH_PT_view3d_tools(_ToolsPanel, bpy.types.Panel):
    bl_space_type = "VIEW_3D"
    bl_parent_id = "HOLOMORPH_PT_view3d"

    def draw(self, context):
        super().draw(context)
        column = self.layout.column(align=True)
        column.operator(HOLOMORPH_OT_compare.bl_idname)
        column.operator(HOLOMORPH_OT_carry.bl_idname)


class HOLOMORPH_PT_image_tools(_ToolsPanel, bpy.types.Panel):
    bl_space_type = "IMAGE_EDITOR"
    bl_parent_id = "HOLOMORPH_PT_image"


def _draw_texels(layout, manager):
    column = layout.column(align=True)
    column.prop(manager, texel_operators.TEXELS)
    column.prop(manager, texel_operators.IMAGE)
    row = column.row(align=True)
    row.operator(texel_operators.HOLOMORPH_OT_texels_get.bl_idname, text="Get")
    row.operator(texel_operators.HOLOMORPH_OT_texels_set.bl_idname, text="Set")


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_PT_view3d_tools, HOLOMORPH_PT_image_tools])
