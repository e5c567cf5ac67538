"""The add-on's tab in a sidebar, and its buttons."""

import bpy
from screen import area, click, draw, event, move, region

TABS_STEP = 30  # pixels; a tab is longer
BUTTONS = {"presets": 16, "maps": 51, "drag": 197}  # pixels below the top of the sidebar
drawn = {"VIEW_3D": 0, "IMAGE_EDITOR": 0}


def count_draws(panel, kind):
    original = panel.draw

    def draw(self, context):
        drawn[kind] += 1
        original(self, context)

    panel.draw = draw


def open_sidebar(seen):
    """Opens the sidebar of the 3D view at our tab."""
    area("VIEW_3D").spaces.active.show_region_ui = True
    count_draws(bpy.types.HOLOMORPH_PT_view3d, "VIEW_3D")
    yield 0.25
    yield from open_tab("VIEW_3D", seen)


def open_tab(kind, seen):
    """Clicks along the tabs from the lowest, ours, upwards until our panel is drawn."""
    sidebar = region(area(kind), "UI")
    for height in range(40, sidebar.height, TABS_STEP):
        before = drawn[kind]
        click(sidebar.x + sidebar.width - 8, sidebar.y + height)
        yield 0.1
        draw()  # now: in Blender 5, a second click at a tab closes the sidebar
        if drawn[kind] > before:
            seen[f"tab in {kind}"] = True
            return


def press_button(kind, button="maps", right=0.4):
    """Clicks one of our buttons, unhurriedly: they are below the panel's header, at the top of the sidebar."""
    sidebar = region(area(kind), "UI")
    move(sidebar.x + sidebar.width * right, sidebar.y + sidebar.height - BUTTONS[button])
    yield 0.1
    event("LEFTMOUSE", "PRESS")
    yield 0.1
    event("LEFTMOUSE", "RELEASE")
