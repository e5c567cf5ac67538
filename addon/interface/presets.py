# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets that come with the add-on, in Blender's own menu of an operator's presets.

Blender looks for presets in folders of its own, whose list an add-on can extend in new versions only.
"""

from pathlib import Path

import bpy

from ..operators.mapping import HOLOMORPH_OT_maps, HOLOMORPH_OT_tile

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
    if not bpy.app.background:
        for name in NAMES:  # without a folder for the user's own presets, Blender's menu says that paths are missing
            bpy.utils.user_resource("SCRIPTS", path=str(Path("presets", "operator", name)), create=True)
    getattr(bpy.types, MENU).append(_draw)


def unregister():
    getattr(bpy.types, MENU).remove(_draw)
