# SPDX-License-Identifier: GPL-3.0-or-later
"""The 3D views of a window are switched so that a texture is seen, and back."""

from .. import compatibility
from . import material

WITHOUT_TEXTURE = {"SOLID", "WIREFRAME"}  # kinds of shading
IMAGE, MATERIAL = "SOLID", "MATERIAL"  # kinds that show an image over the UV square, and a material as it is
COLOUR = "TEXTURE"  # what the colour of `IMAGE` is
BEFORE = "holomorph_shading"  # custom property of a screen: index of an area -> kind and colour as they were, kind now


def show(window, shown=IMAGE):
    """Sets one of these kinds of shading in the views that would not show a texture; the others stay."""
    before = dict(window.screen.get(BEFORE, {}))
    for index, shading in _views(window):
        kind = shading.type
        if kind in WITHOUT_TEXTURE and (shown, kind, shading.color_type) != (IMAGE, IMAGE, COLOUR):
            shading.type = IMAGE  # first: the colours that there are depend on it
            before[index] = [*(before.get(index) or [kind, shading.color_type])[:2], shown]
            shading.color_type = COLOUR
            shading.type = shown
    if before:
        window.screen[BEFORE] = before


def restore(window):
    """Takes back what `show` changed, except in views whose shading was chosen anew since."""
    before = dict(window.screen.get(BEFORE, {}))
    for index, shading in _views(window):
        kind, colour, shown = before.get(index, [None] * 3)
        if shading.type == shown and (shown == MATERIAL or shading.color_type == COLOUR):
            shading.type = IMAGE
            shading.color_type = colour
            shading.type = kind
    if before:
        del window.screen[BEFORE]


def restore_without_textures(context):
    """Restores the window's views once no mesh shows a texture of ours."""
    meshes = [obj for obj in compatibility.objects_in(context.view_layer) if obj.type == "MESH"]
    if context.window is not None and not any(material.is_covered(obj) for obj in meshes):
        restore(context.window)


def _views(window):
    """(index as text, shading) of each 3D view."""
    areas = enumerate(window.screen.areas)
    return [(str(index), area.spaces.active.shading) for index, area in areas if area.type == "VIEW_3D"]
