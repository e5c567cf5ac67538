# SPDX-License-Identifier: GPL-3.0-or-later
"""Holomorph: conformal UV maps for surfaces of any shape, in Blender."""

bl_info = {
    "name": "Holomorph",
    "description": "Conformal UV maps for surfaces of any shape",
    "author": "The Holomorph authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View and UV Editor > Sidebar > Holomorph; UV menus",
    "category": "UV",
}


def register():
    from . import (
        carry,
        compare,
        drag,
        lod,
        native,
        operators,
        overlay,
        panel,
        preferences,
        presets,
        shortcuts,
        submit,
        texel_operators,
        tile,
        tools,
        tools_panel,
    )

    native.forget()
    preferences.register()
    operators.register()
    tile.register()
    drag.register()
    lod.register()
    texel_operators.register()
    compare.register()
    carry.register()
    overlay.register()
    tools.register()
    submit.register()
    presets.register()
    panel.register()
    tools_panel.register()
    shortcuts.register()


def unregister():
    from . import (
        carry,
        compare,
        drag,
        lod,
        operators,
        overlay,
        panel,
        preferences,
        presets,
        shortcuts,
        submit,
        texel_operators,
        tile,
        tools,
        tools_panel,
    )

    shortcuts.unregister()
    tools_panel.unregister()
    panel.unregister()
    presets.unregister()
    submit.unregister()
    tools.unregister()
    overlay.unregister()
    carry.unregister()
    compare.unregister()
    texel_operators.unregister()
    lod.unregister()
    drag.unregister()
    tile.unregister()
    operators.unregister()
    preferences.unregister()
