"""What an artist does with an object: looks at it, presses the large button, then what the panel offers next."""

import json

import bpy
from objects import look_at, pick
from running import wait_until
from screen import area, enter, inside, picture
from sidebar import open_sidebar, press_button

seen = {}


def prepare():
    yield from enter("Layout")
    yield from open_sidebar(seen)
    for obj in list(bpy.data.objects):
        if obj.name != "Cube":
            bpy.data.objects.remove(obj)


def report_of(name):
    obj = bpy.data.objects.get(name)
    return json.loads(obj["holomorph_report"]) if obj is not None and "holomorph_report" in obj else None


def wait_for(name, before=None):
    """Until there is another report on the object."""
    yield from wait_until(lambda: report_of(name) not in (None, before))
    yield 0.25


def note(step, name, picture_name):
    found = report_of(name)
    seen[step] = found and found["verdict"] | {"maps": [each["name"] for each in found["maps"]]}
    yield 0.12
    picture(picture_name)


def press(step, name):
    """The large button."""
    look_at(name)
    yield 0.25
    yield from press_button("VIEW_3D")
    yield from wait_for(name)
    yield from note(step, name, f"five_{step}.png")


def then(step, name, operator, on=None, **options):
    """What the panel offers next, for this object or that; its report is on the first."""
    before = report_of(name)
    pick(on or name)
    with inside(area("VIEW_3D")):
        try:
            operator("INVOKE_DEFAULT", **options)
        except RuntimeError as error:  # what the status bar says
            seen[f"{step}: told"] = str(error)
            picture(f"five_{step}.png")
            return
    yield from wait_for(name, before)
    yield from note(step, name, f"five_{step}.png")
