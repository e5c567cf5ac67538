"""The pie menu and its keys."""

import bpy
from loaded_addon import module
from scenes import torus

shortcuts = module("interface.menus")


class Pie:
    """Takes down which operators are drawn."""

    def __init__(self):
        self.drawn = []

    def menu_pie(self):
        return self

    def operator(self, name, **_look):
        self.drawn.append(name)
        return type("Properties", (), {})()

    def prop(self, _owner, name):
        self.drawn.append(name)


def draw():
    pie = Pie()
    shortcuts.HOLOMORPH_MT_pie.draw(type("Menu", (), {"layout": pie}), bpy.context)
    return pie.drawn


def test_the_entries_are_operators_and_a_switch_and_all_eight_directions_are_taken():
    torus()
    for mode in ("OBJECT", "EDIT"):
        bpy.ops.object.mode_set(mode=mode)
        drawn = draw()
        assert len(drawn) == 8 and drawn[:2] == ["uv.holomorphic_maps", "uv.holomorphic_drag_poles"]
        for name in drawn[:3] + drawn[4:]:  # above is a switch
            room, operator = name.split(".")
            assert operator in dir(getattr(bpy.ops, room))


def test_the_keys_are_added_and_taken_back(addon):
    keys = bpy.context.window_manager.keyconfigs.addon
    if keys is None:
        return
    found = {(keymap.name, item.idname) for keymap in keys.keymaps for item in keymap.keymap_items}
    for name, _ in shortcuts.KEYMAPS:
        assert {(name, "wm.call_menu_pie"), (name, "uv.holomorphic_maps")} <= found
    addon.unregister()
    left = {item.idname for keymap in keys.keymaps for item in keymap.keymap_items}
    addon.register()
    assert "uv.holomorphic_maps" not in left
