# SPDX-License-Identifier: GPL-3.0-or-later
"""Holomorph: conformal UV maps for surfaces of any shape, in Blender.

Registration loads neither NumPy nor the native core, so that the panel can say what is missing. Operators and drawing
import what needs these inside their functions.
"""

from . import headless, native, preferences
from .interface import map_panel, menus, panel, words
from .operators import (
    bake,
    dials,
    drag,
    elements,
    follow,
    geometry,
    lod,
    mapping,
    quads,
    relief,
    symmetric,
    texel_operators,
    tools,
)
from .overlays import overlay

bl_info = {
    "name": "Holomorph",
    "description": "Conformal UV maps for surfaces of any shape",
    "author": "The Holomorph authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View and UV Editor > Sidebar > Holomorph; UV menus",
    "category": "UV",
    "doc_url": "",
    "tracker_url": "",
}

# In the order of registration.
MODULES = (
    preferences,
    dials,
    mapping,
    follow,
    drag,
    elements,
    lod,
    quads,
    geometry,
    relief,
    symmetric,
    texel_operators,
    bake,
    overlay,
    tools,
    words,
    map_panel,
    menus,
    panel,
    headless,
)


def register():
    native.forget()
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
