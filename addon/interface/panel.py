# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab "Holomorph" of the 3D view and the UV editor, and the entries in both UV menus."""

import bpy

from .. import native
from ..operators.availability import CONVERT, CONVERTIBLE
from ..operators.compare import HOLOMORPH_OT_compare
from ..operators.drag import HOLOMORPH_OT_drag_poles
from ..operators.lod import HOLOMORPH_OT_levels
from ..operators.mapping import HOLOMORPH_OT_islands, HOLOMORPH_OT_maps, HOLOMORPH_OT_tile
from ..operators.tools import HOLOMORPH_OT_heat, HOLOMORPH_OT_restore_materials
from ..overlays import overlay
from . import lines, tools_panel

INDENT = 8  # spaces before what is continued on a further line


class _HolomorphPanel:
    bl_label = "Holomorph"
    bl_category = "Holomorph"
    bl_region_type = "UI"

    def draw(self, context):
        layout = self.layout
        column = layout.column(align=True)
        column.operator(HOLOMORPH_OT_maps.bl_idname, icon="UV")
        column.operator(HOLOMORPH_OT_tile.bl_idname, icon="TEXTURE")
        if native.problem():
            lines.draw(layout.column(align=True), context, native.problem(), "ERROR")
            return
        if context.mode == "EDIT_MESH":
            _draw_choices(layout)
        obj = context.active_object
        if obj is not None and obj.type == "MESH":
            if context.mode == "OBJECT":
                tools_panel.draw_modifiers(column, context, obj)
                layout.operator(HOLOMORPH_OT_levels.bl_idname, text="Levels of Detail", icon="MOD_DECIM")
            _draw_result(layout, context, obj)
        elif obj is not None and obj.type in CONVERTIBLE:
            lines.draw(column, context, CONVERT, "INFO")
        if context.mode == "OBJECT":
            layout.operator(HOLOMORPH_OT_compare.bl_idname, icon="ARROW_LEFTRIGHT")
            _draw_overlays(layout, context)


class HOLOMORPH_PT_view3d(_HolomorphPanel, bpy.types.Panel):
    bl_space_type = "VIEW_3D"


class HOLOMORPH_PT_image(_HolomorphPanel, bpy.types.Panel):
    bl_space_type = "IMAGE_EDITOR"


class _DetailsPanel:
    """The mathematics of the last result."""

    bl_label = "Details"
    bl_category = "Holomorph"
    bl_region_type = "UI"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        if native.problem() or context.active_object is None:
            return False
        from ..results import report

        return report.PROPERTY in context.active_object

    def draw(self, context):
        from ..results import report, stored

        column = self.layout.column(align=True)
        for line in stored.summary(context.active_object[report.PROPERTY]):
            lines.draw(column, context, line, indent=INDENT)


class HOLOMORPH_PT_view3d_details(_DetailsPanel, bpy.types.Panel):
    bl_space_type = "VIEW_3D"
    bl_parent_id = "HOLOMORPH_PT_view3d"


class HOLOMORPH_PT_image_details(_DetailsPanel, bpy.types.Panel):
    bl_space_type = "IMAGE_EDITOR"
    bl_parent_id = "HOLOMORPH_PT_image"


def _draw_choices(layout):
    """The button again, for what the selected vertices are to be."""
    column = layout.column(align=True)
    column.label(text="Selected vertices as")
    for use, text in (("PUNCTURES", "Punctures"), ("RECTANGLE", "Corners of a Rectangle")):
        column.operator(HOLOMORPH_OT_maps.bl_idname, text=text).use_selection = use


def _draw_overlays(layout, context):
    column = layout.column(align=True)
    column.label(text="Heat map of the active UV map")
    column.row(align=True).prop(context.window_manager, overlay.HEAT, expand=True)
    column.operator(HOLOMORPH_OT_heat.bl_idname, text="Store as Face Attributes")
    row = layout.row(align=True)
    row.prop(context.window_manager, overlay.MARKS, toggle=True)
    row.operator(HOLOMORPH_OT_drag_poles.bl_idname)


def _draw_result(layout, context, obj):
    from ..results import report, restore
    from . import verdict_view

    if restore.is_possible(obj):
        layout.operator(HOLOMORPH_OT_restore_materials.bl_idname, icon="MATERIAL")
    if obj.get(report.PROPERTY):
        verdict_view.draw(
            layout, context, obj[report.PROPERTY], HOLOMORPH_OT_tile.bl_idname, HOLOMORPH_OT_islands.bl_idname
        )


def _draw_menu_entry(self, _context):
    self.layout.separator()
    self.layout.operator_context = "INVOKE_DEFAULT"
    self.layout.operator(HOLOMORPH_OT_maps.bl_idname)
    self.layout.operator(HOLOMORPH_OT_tile.bl_idname)


CLASSES = (HOLOMORPH_PT_view3d, HOLOMORPH_PT_image, HOLOMORPH_PT_view3d_details, HOLOMORPH_PT_image_details)
MENUS = ("VIEW3D_MT_uv_map", "IMAGE_MT_uvs")


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    for name in MENUS:
        getattr(bpy.types, name).append(_draw_menu_entry)


def unregister():
    for name in MENUS:
        getattr(bpy.types, name).remove(_draw_menu_entry)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
