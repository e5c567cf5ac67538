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
    from . import heat, lod, native, operators, overlay, panel

    native.forget()
    operators.register()
    lod.register()
    heat.register()
    overlay.register()
    panel.register()


def unregister():
    from . import heat, lod, operators, overlay, panel

    panel.unregister()
    overlay.unregister()
    heat.unregister()
    lod.unregister()
    operators.unregister()
