# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures of the user's that are averaged over the turns of the map that shows them; the report keeps that."""

from dataclasses import asdict

from ..materials import material, user_texture
from ..scene import gathering
from . import report, stored, write


def shown_turns(text):
    """2, 4 or 6 where a map in a stored report turns by that, and a texture of the user's on it does not; else 0."""
    turns, own = stored.turns(text), stored.parsed(text).get("dials", {}).get("own")
    return turns if own and own.get("turns", 1) % turns else 0


def make(obj, coverings):
    """Shows the texture averaged, on all objects with this mesh that show it. Returns why not, or ""; None where there
    is nothing to do.

    coverings : the materials for other objects, by what they show; one may be added
    """
    text = obj.get(report.PROPERTY)
    turns, entry = shown_turns(text), stored.parsed(text)
    options = write.options_of(entry["dials"]) if turns else None
    if options is None or options.own is None or not material.is_covered(obj):
        return None
    try:
        own = user_texture.symmetric(options.own, turns)
    except ValueError as error:
        return str(error)
    shown = entry["maps"][min(options.shown, len(entry["maps"]) - 1)]
    repeats = max(1, round(options.checker_scale))
    look = material.Look(options.texture, repeats, 0.0, True, own.on_turned(turns), True)
    key = shown["name"], shown["stored_as"] == "attribute", look
    coverings[key] = covering = coverings.get(key) or material.showing(*key)
    for each in (obj, *gathering.others(obj)):
        if material.is_covered(each):
            material.cover(each, covering)
    report.store(obj, {**entry, "dials": {**entry["dials"], "own": asdict(own)}})
    return ""


def as_before(own, objects):
    """The texture, averaged where one of the objects shows it so, and it still can be."""
    for obj in objects:
        before = stored.parsed(obj.get(report.PROPERTY)).get("dials", {}).get("own") or {}
        if (before.get("kind"), before.get("name")) == (own.kind, own.name) and before.get("averaged", 1) != 1:
            try:
                return user_texture.symmetric(own, before["averaged"])
            except ValueError:
                return own
    return own
