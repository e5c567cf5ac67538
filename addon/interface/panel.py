# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab "Holomorph" of the 3D view and the UV editor, its sub-panels, and the entries in both UV menus."""

import bpy

from .. import native
from ..operators import (
    bake,
    elements,
    geometry,
    lod,
    quads,
    relief,
    texel_operators,
    tools,
)
from ..operators.mapping import HOLOMORPH_OT_maps, HOLOMORPH_OT_tile
from ..operators.mixins import TAB
from ..overlays import overlay
from ..scene import stored_dials
from . import lines, map_panel, menus

INDENT = 8  # spaces before what is continued on a further line


class _Panel:
    bl_label = "Holomorph"
    bl_category = TAB
    bl_region_type = "UI"


class _MapPanel(map_panel.MapPanel, _Panel):
    def draw_header_preset(self, _context):
        self.layout.enabled = not map_panel.is_blocked()
        menus.HOLOMORPH_PT_presets.draw_panel_header(self.layout)


class _AdvancedPanel(map_panel.AdvancedPanel, _Panel):
    pass


class _ResearchPanel(map_panel.ResearchPanel, _Panel):
    pass


class _DetailsPanel(_Panel):
    """The mathematics of the last result."""

    bl_label = "Details"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return not native.problem() and stored_dials.made(context.active_object) is not None

    def draw(self, context):
        column, made = self.layout.column(align=True), stored_dials.made(context.active_object)
        for numbers in made.numbers.splitlines():
            row = column.split(factor=0.72)
            for text in numbers.split("\t"):
                row.label(text=text)
        for line in made.summary.splitlines():
            lines.draw(column, context, line, indent=INDENT)


class _CheckPanel(_Panel):
    """What is seen of the active UV map, and what of the mesh."""

    bl_label = "Check"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        column = self.layout.column(align=True)
        if context.mode == "OBJECT":
            column.label(text="Heat map of the active UV map")
            column.prop(context.window_manager, overlay.HEAT, expand=True)
            column.operator(tools.HOLOMORPH_OT_heat.bl_idname, text="Store as Face Attributes")
        column = self.layout.column(align=True)
        column.operator(elements.HOLOMORPH_OT_select_bad.bl_idname)
        column.operator(elements.HOLOMORPH_OT_select_stretched.bl_idname)
        column.operator(elements.HOLOMORPH_OT_repair.bl_idname)


class _ThingsPanel(_Panel):
    """What is made of a map."""

    bl_label = "From This Map"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return not native.problem() and context.mode == "OBJECT"

    def draw(self, _context):
        column = self.layout.column(align=True)
        column.operator(quads.HOLOMORPH_OT_quads.bl_idname, icon="MOD_REMESH")
        column.operator(geometry.HOLOMORPH_OT_geometry.bl_idname, icon="MOD_ARRAY")
        column.operator(geometry.HOLOMORPH_OT_lines.bl_idname, icon="MOD_WIREFRAME")
        column.operator(geometry.HOLOMORPH_OT_cells.bl_idname, icon="MESH_GRID")
        column.operator(relief.HOLOMORPH_OT_relief.bl_idname, icon="RNDCURVE")
        column.operator(bake.HOLOMORPH_OT_bake.bl_idname, icon="RENDER_STILL")
        column.operator(lod.HOLOMORPH_OT_levels.bl_idname, text="Levels of Detail", icon="MOD_DECIM")


class _ToolsPanel(_Panel):
    bl_label = "Tools"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        column = self.layout.column(align=True)
        column.prop(context.window_manager, texel_operators.TEXELS)
        column.prop(context.window_manager, texel_operators.IMAGE)
        row = column.row(align=True)
        row.operator(texel_operators.HOLOMORPH_OT_texels_get.bl_idname, text="Get")
        row.operator(texel_operators.HOLOMORPH_OT_texels_set.bl_idname, text="Set")
        column = self.layout.column(align=True)
        column.operator(tools.HOLOMORPH_OT_restore_materials.bl_idname)
        column.operator(tools.HOLOMORPH_OT_remove_maps.bl_idname)
        column.operator(tools.HOLOMORPH_OT_assets.bl_idname)


def _draw_menu_entry(self, _context):
    self.layout.separator()
    self.layout.operator_context = "INVOKE_DEFAULT"
    self.layout.operator(HOLOMORPH_OT_maps.bl_idname)
    self.layout.operator(HOLOMORPH_OT_tile.bl_idname)
    self.layout.operator(elements.HOLOMORPH_OT_repair.bl_idname)


def _while_free(draw):
    """A panel's `draw`; what it draws cannot be pressed while work is going on."""

    def draw_it(self, context):
        self.layout.enabled = not map_panel.is_blocked()
        draw(self, context)

    return draw_it


def _panels(name, space):
    """The panels of one kind of editor."""

    def made(base, end="", parent=""):
        settings = {"bl_space_type": space} | ({"bl_parent_id": parent} if parent else {})
        settings |= {"draw": _while_free(base.draw)} if base is not _MapPanel else {}
        return type(name + end, (base, bpy.types.Panel), settings)

    return [
        made(_MapPanel),
        made(_AdvancedPanel, "_advanced", name),
        made(_ResearchPanel, "_research", name),
        made(_DetailsPanel, "_details", name),
        made(_CheckPanel, "_check"),
        made(_ThingsPanel, "_things"),
        made(_ToolsPanel, "_tools"),
    ]


_register_panels, _unregister_panels = bpy.utils.register_classes_factory(
    [*_panels("HOLOMORPH_PT_view3d", "VIEW_3D"), *_panels("HOLOMORPH_PT_image", "IMAGE_EDITOR")]
)


def _draw_object_entry(self, _context):
    self.layout.separator()
    self.layout.operator_context = "INVOKE_DEFAULT"
    self.layout.operator(quads.HOLOMORPH_OT_quads.bl_idname, text="Holomorphic Quads")


MENUS = {
    "VIEW3D_MT_uv_map": _draw_menu_entry,
    "IMAGE_MT_uvs": _draw_menu_entry,
    "VIEW3D_MT_object": _draw_object_entry,
}


def register():
    _register_panels()
    for name, draw in MENUS.items():
        getattr(bpy.types, name).append(draw)


def unregister():
    for name, draw in MENUS.items():
        getattr(bpy.types, name).remove(draw)
    _unregister_panels()
