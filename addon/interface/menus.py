# SPDX-License-Identifier: GPL-3.0-or-later
"""The pie menu, the keys, and the presets that come with the add-on.

Shift U is for the pie menu, Ctrl Shift U for the maps: Preferences, Keymap, has both. The presets are in Blender's own
menu of an operator's presets: Blender looks for presets in folders of its own, whose list an add-on can extend in new
versions only.
"""

from pathlib import Path

import bpy

from ..operators import texel_operators
from ..operators.drag import HOLOMORPH_OT_drag_poles
from ..operators.elements import HOLOMORPH_OT_select_bad
from ..operators.lod import HOLOMORPH_OT_levels
from ..operators.mapping import HOLOMORPH_OT_maps, HOLOMORPH_OT_tile
from ..operators.tools import HOLOMORPH_OT_remove_maps, HOLOMORPH_OT_restore_materials

KEY = "U"
KEYMAPS = ("Object Mode", "EMPTY"), ("Mesh", "EMPTY"), ("UV Editor", "EMPTY")  # name, kind of space

_entries = []  # (keymap, its item)


class HOLOMORPH_MT_pie(bpy.types.Menu):
    bl_label = "Holomorph"

    def draw(self, context):
        pie = self.layout.menu_pie()
        pie.operator_context = "INVOKE_DEFAULT"
        pie.operator(HOLOMORPH_OT_maps.bl_idname, icon="UV")  # from the left, then right, below, above, the corners
        pie.operator(HOLOMORPH_OT_tile.bl_idname, icon="TEXTURE")
        if context.mode == "EDIT_MESH":
            pie.operator(HOLOMORPH_OT_maps.bl_idname, text="Corners of a Rectangle").use_selection = "RECTANGLE"
            pie.operator(HOLOMORPH_OT_maps.bl_idname, text="Poles").use_selection = "POLES"
        else:
            pie.operator(HOLOMORPH_OT_levels.bl_idname, text="Levels of Detail", icon="MOD_DECIM")
            pie.operator(HOLOMORPH_OT_drag_poles.bl_idname)
        pie.operator(HOLOMORPH_OT_restore_materials.bl_idname, icon="MATERIAL")
        pie.operator(HOLOMORPH_OT_remove_maps.bl_idname, icon="X")
        pie.operator(HOLOMORPH_OT_select_bad.bl_idname, icon="ERROR")
        pie.operator(texel_operators.HOLOMORPH_OT_texels_set.bl_idname)


FOLDER = Path(__file__).parents[1] / "presets" / "operator"
NAMES = HOLOMORPH_OT_maps.bl_idname, HOLOMORPH_OT_tile.bl_idname  # of the operators, and of their folders
MENU = "WM_MT_operator_presets"


def _draw(menu, context):
    operator = context.active_operator
    name = next((n for n in NAMES if operator is not None and operator.bl_idname == _class_name(n)), None)
    if name is None:
        return
    menu.layout.separator()
    menu.path_menu(
        [str(FOLDER / name)],
        menu.preset_operator,
        props_default={"menu_idname": MENU},
        filter_ext=lambda extension: extension == ".py",
    )


def _class_name(idname):
    """The name of an operator's class, as an operator that was run has it."""
    room, name = idname.split(".")
    return f"{room.upper()}_OT_{name}"


def register():
    _register_keys()
    if not bpy.app.background:
        for name in NAMES:  # without a folder for the user's own presets, Blender's menu says that paths are missing
            bpy.utils.user_resource("SCRIPTS", path=str(Path("presets", "operator", name)), create=True)
    getattr(bpy.types, MENU).append(_draw)


def _register_keys():
    bpy.utils.register_class(HOLOMORPH_MT_pie)
    keys = bpy.context.window_manager.keyconfigs.addon
    if keys is None:  # without a window
        return
    for name, space in KEYMAPS:
        keymap = keys.keymaps.new(name=name, space_type=space)
        pie = keymap.keymap_items.new("wm.call_menu_pie", KEY, "PRESS", shift=True)
        pie.properties.name = HOLOMORPH_MT_pie.__name__
        maps = keymap.keymap_items.new(HOLOMORPH_OT_maps.bl_idname, KEY, "PRESS", shift=True, ctrl=True)
        _entries.extend([(keymap, pie), (keymap, maps)])


def unregister():
    getattr(bpy.types, MENU).remove(_draw)
    while _entries:
        keymap, item = _entries.pop()
        keymap.keymap_items.remove(item)
    bpy.utils.unregister_class(HOLOMORPH_MT_pie)
