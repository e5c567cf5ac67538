"""Blender's preferences in the place of the 3D view, from 4.2 on; and its file browser."""

import bpy
from screen import area, enter, hover, picture, region, tap

PACKAGE = "bl_ext.user_default.holomorph"  # of the extension that is installed


def open_section(name):
    """The region of that section of the preferences, without the rest of the window."""
    if not any(one.type == "PREFERENCES" for one in bpy.context.window_manager.windows[0].screen.areas):
        yield from enter("Layout")
        bpy.context.preferences.view.filebrowser_display_type = "SCREEN"
        area("VIEW_3D").type = "PREFERENCES"
    bpy.context.preferences.active_section = name
    yield 1
    return region(area("PREFERENCES"), "WINDOW")


def pick_file(folder, name, picture_name):
    """In the file browser that is open: as typed, then Enter."""
    browser = area("FILE_BROWSER")
    browser.spaces.active.params.directory = str(folder).encode()
    browser.spaces.active.params.filename = name
    yield 0.5
    hover(browser)
    yield 0.3
    picture(picture_name)
    tap("RET")
