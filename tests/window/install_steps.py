"""Runs inside Blender 4.2 or later with a window and simulated events: installs the extension, as an artist does.

Takes FOLDER/holomorph.zip; leaves FOLDER/install_steps.json and pictures.
"""

import bpy
from preferences import PACKAGE, open_section, pick_file
from running import run, wait_until
from screen import FOLDER, click, picture, tap

FROM_DISK = "F"  # the key of the entry in the menu
MENU = (19, 24)  # pixels from the right and the top of the section
seen = {}


def is_enabled():
    return PACKAGE in bpy.context.preferences.addons


def install_from_disk():
    seen["before"] = is_enabled()
    section = yield from open_section("EXTENSIONS")
    picture("install_extensions.png")
    click(section.x + section.width - MENU[0], section.y + section.height - MENU[1])
    yield 0.5
    picture("install_menu.png")
    tap(FROM_DISK)
    yield 1
    yield from pick_file(FOLDER, "holomorph.zip", "install_file.png")
    yield from wait_until(is_enabled)
    yield 1
    seen["after"] = is_enabled()
    seen["has operator"] = hasattr(bpy.types, "UV_OT_holomorphic_maps")
    bpy.ops.wm.save_userpref()
    yield from open_section("ADDONS")
    picture("install_addons.png")


run([install_from_disk], seen)
