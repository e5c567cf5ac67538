# SPDX-License-Identifier: GPL-3.0-or-later
"""The pie menu, the keys, and the presets of the dials.

Shift U is for the pie menu, Ctrl Shift U for the button: Preferences, Keymap, has both. A preset sets dials of the
active object: some come with the add-on, further ones are files of the user's.
"""

from pathlib import Path

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel
from bpy.props import EnumProperty, StringProperty

from ..operators.drag import HOLOMORPH_OT_drag_poles
from ..operators.elements import HOLOMORPH_OT_select_stretched
from ..operators.mapping import HOLOMORPH_OT_islands, HOLOMORPH_OT_maps, press
from ..operators.mixins import OnMeshes
from ..operators.properties import Dials
from ..operators.tools import HOLOMORPH_OT_remove_maps, HOLOMORPH_OT_restore_materials
from ..overlays import overlay
from ..scene import stored_dials

KEY = "U"
KEYMAPS = ("Object Mode", "EMPTY"), ("Mesh", "EMPTY"), ("UV Editor", "EMPTY")  # name, kind of space
FOLDER = "holomorph"  # of the user's own presets, in those of Blender
USUAL = {"tiles": 100, "size": 0.0, "lattice": "square", "direction": "UPRIGHT", "boundary": "automatic"}
USUAL |= {"checker": True, "repeats": 1}
PRESETS = {  # beside what is usual
    "Automatic": {"texture": "CHECKER", "tiles": 0, "lattice": "automatic"},
    "Bricks": {"texture": "BRICKS", "repeats": 2},
    "Cloth": {"texture": "WEAVE", "repeats": 2},
    "Hexagons": {"texture": "HEXAGONS", "boundary": "free"},
    "Numbered Check": {"texture": "NUMBERED", "tiles": 0},
    "Planks": {"texture": "PLANKS", "tiles": 60, "direction": "Z", "repeats": 3},
    "Scales": {"texture": "SCALES", "boundary": "free"},
    "Wood": {"texture": "PLANKS", "tiles": 60, "direction": "Z"},
}
OF_ONE_OBJECT = {"source", "pole_group"}  # dials that name what another object may lack

_entries = []  # (keymap, its item)


class HOLOMORPH_PT_presets(PresetPanel, bpy.types.Panel):
    bl_label = "Presets"
    preset_subdir = FOLDER
    preset_operator = "uv.holomorphic_preset"
    preset_add_operator = "uv.holomorphic_preset_add"

    def draw(self, _context):
        self.layout.emboss, self.layout.operator_context = "PULLDOWN_MENU", "EXEC_DEFAULT"
        column = self.layout.column(align=True)
        for name in PRESETS:
            column.operator(self.preset_operator, text=name, translate=False).preset = name
        self.path_menu(
            bpy.utils.preset_paths(self.preset_subdir),
            self.preset_operator,
            filter_ext=lambda end: end == ".py",
            add_operator=self.preset_add_operator,
        )


class HOLOMORPH_OT_preset_add(AddPresetBase, bpy.types.Operator):
    """Keep the dials of the active object under a name, or remove what has this name"""

    bl_idname = HOLOMORPH_PT_presets.preset_add_operator
    bl_label = "Add Preset"
    preset_menu = HOLOMORPH_PT_presets.__name__
    preset_subdir = HOLOMORPH_PT_presets.preset_subdir
    preset_defines = [f"dials = bpy.context.active_object.{stored_dials.NAME}"]
    preset_values = [f"dials.{name}" for name in Dials.__annotations__ if name not in OF_ONE_OBJECT]


class HOLOMORPH_OT_preset(OnMeshes, bpy.types.Operator):
    """Set the dials, and make the map of them"""

    bl_idname = HOLOMORPH_PT_presets.preset_operator
    bl_label = "Preset"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}
    preset: EnumProperty(items=[(name, name, "") for name in PRESETS], options={"HIDDEN", "SKIP_SAVE"})
    filepath: StringProperty(subtype="FILE_PATH", options={"HIDDEN", "SKIP_SAVE"})  # a file's, in place of ours

    def execute(self, context):
        if self.filepath:
            with stored_dials.quietly():
                bpy.utils.execfile(self.filepath)
        else:
            stored_dials.write(context.active_object, USUAL | PRESETS[self.preset])
        return press(context.active_object) - {"RUNNING_MODAL"} or {"FINISHED"}


class HOLOMORPH_MT_pie(bpy.types.Menu):
    bl_label = "Holomorph"

    def draw(self, context):
        pie = self.layout.menu_pie()
        pie.operator_context = "INVOKE_DEFAULT"
        pie.operator(HOLOMORPH_OT_maps.bl_idname, icon="UV")  # from the left, then right, below, above, the corners
        pie.operator(HOLOMORPH_OT_drag_poles.bl_idname, icon="VIEW_PAN")
        pie.operator(HOLOMORPH_OT_islands.bl_idname, icon="UV_ISLANDSEL")
        pie.prop(context.window_manager, overlay.MARKS)
        presets = pie.operator("wm.call_panel", text=HOLOMORPH_PT_presets.bl_label, icon="PRESET")
        presets.name = HOLOMORPH_PT_presets.__name__
        pie.operator(HOLOMORPH_OT_select_stretched.bl_idname, icon="ERROR")
        pie.operator(HOLOMORPH_OT_restore_materials.bl_idname, icon="MATERIAL")
        pie.operator(HOLOMORPH_OT_remove_maps.bl_idname, icon="X")


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    [HOLOMORPH_PT_presets, HOLOMORPH_OT_preset_add, HOLOMORPH_OT_preset, HOLOMORPH_MT_pie]
)


def register():
    _register_classes()
    if not bpy.app.background:  # without a folder for the user's own, Blender says that paths are missing
        bpy.utils.user_resource("SCRIPTS", path=str(Path("presets", FOLDER)), create=True)
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
    while _entries:
        keymap, item = _entries.pop()
        keymap.keymap_items.remove(item)
    _unregister_classes()
