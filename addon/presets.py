# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of the tile operator that come with the add-on, in Blender's own menu of an operator's presets.

Blender looks for presets in folders of its own, whose list an add-on can extend in new versions only.
"""

from pathlib import Path

import bpy

from .tile import HOLOMORPH_OT_tile

FOLDER = Path(__file__).parent / "presets" / "operator" / HOLOMORPH_OT_tile.bl_idname
MENU = "WM_MT_operator_presets"


def _draw(menu, context):
    operator = context.active_operator
    if operator is None or operator.bl_idname != _class_name(HOLOMORPH_OT_tile.bl_idname):
        return
    menu.layout.separator()
    menu.path_menu(
        [str(FOLDER)],
        menu.preset_operator,
        props_default={"menu_idname": MENU},
        filter_ext=lambda extension: extension == ".py",
    )


def _class_name(idname):
    """The name of an operator's class, as an operator that was run has it."""
    room, name = idname.split(".")
    return f"{room.upper()}_OT_{name}"


def register():
    if (
        not bpy.app.background
    ):  # without a folder for the user's own presets, Blender's menu says that paths are missing
        path = str(Path("presets", "operator", HOLOMORPH_OT_tile.bl_idname))
        bpy.utils.user_resource("SCRIPTS", path=path, create=True)
    getattr(bpy.types, MENU).append(_draw)


def unregister():
    getattr(bpy.types, MENU).remove(_draw)
