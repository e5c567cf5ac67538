"""Runs inside Blender 4.2 or later with a window, after install_steps.py: uninstalls the extension.

Leaves FOLDER/uninstall_steps.json and pictures.
"""

from pathlib import Path

import bpy
from preferences import PACKAGE, open_section
from running import run, wait_until
from screen import picture

seen = {}


def is_there():
    return PACKAGE in bpy.context.preferences.addons or hasattr(bpy.types, "HOLOMORPH_PT_view3d")


def uninstall():
    seen["before"] = is_there()
    yield from open_section("EXTENSIONS")
    picture("uninstall_before.png")
    index = bpy.context.preferences.extensions.repos.find("User Default")
    bpy.ops.extensions.package_uninstall("INVOKE_DEFAULT", repo_index=index, pkg_id="holomorph")
    yield from wait_until(lambda: not is_there())
    place = Path(bpy.utils.user_resource("EXTENSIONS"))
    yield from wait_until(lambda: not [*place.rglob("holomorph*")])  # its wheels go later, by another process
    seen["after"] = is_there()
    picture("uninstall_after.png")


run([uninstall], seen)
