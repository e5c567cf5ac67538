# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures of the user's that are averaged over the turns of the map that shows them; objects keep that."""

from ..maps.mapped import SEAMLESS
from ..materials import material, user_texture
from ..scene import gathering, stored_dials, uv_maps


def make(obj, coverings):
    """Shows the texture averaged, on all objects with this mesh that show it. Returns why not, or ""; None where there
    is nothing to do.

    coverings : the materials for other objects, by what they show; one may be added
    """
    made, names = stored_dials.made(obj), uv_maps.own_maps(obj.data)
    turns = made.shown_turns if made else 0
    if not turns or not names or not material.is_covered(obj):
        return None
    try:
        own = user_texture.symmetric(user_texture.chosen(made.dials), turns)
    except ValueError as error:
        return str(error)
    dials = made.dials
    shown, cells = (0, 0.0) if dials.main == SEAMLESS else (dials.shown, dials.checker_scale)
    name, repeats = names[min(shown, len(names) - 1)], max(dials.repeats, round(cells))
    look = material.Look(own.kind, repeats, 0.0, True, own.on_turned(turns), True)
    key = name, not uv_maps.is_uv_map(obj.data, name), look
    coverings[key] = covering = coverings.get(key) or material.showing(*key)
    for each in (obj, *gathering.others(obj)):
        if material.is_covered(each):
            material.cover(each, covering)
        if of_each := stored_dials.made(each):
            of_each.own_turns = of_each.averaged = turns
    return ""


def as_before(own, objects):
    """The texture, averaged where one of the objects shows it so, and it still can be."""
    for made in filter(None, map(stored_dials.made, objects)):
        if (made.dials.texture, made.dials.source) == (own.kind, own.name) and made.averaged != 1:
            try:
                return user_texture.symmetric(own, made.averaged)
            except ValueError:
                return own
    return own
