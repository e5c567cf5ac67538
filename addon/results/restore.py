# SPDX-License-Identifier: GPL-3.0-or-later
"""What an object showed before its maps were made: its materials, and the active UV maps of its mesh."""

from ..materials import material
from ..scene import gathering, stored_dials, uv_maps
from . import heat, report, tags

BEFORE = "holomorph_shown_before"  # custom property of a mesh: the UV maps that were active, in editors and for renders


def remember(mesh):
    """Notes which active maps are not ours. @pre ours are not yet removed or written"""
    before = dict(mesh.get(BEFORE, {}))
    active, rendered = mesh.uv_layers.active, next((layer for layer in mesh.uv_layers if layer.active_render), None)
    for use, layer in (("active", active), ("rendered", rendered)):
        if layer is not None and layer.name not in (*uv_maps.own_maps(mesh), uv_maps.bake_map(mesh)):
            before[use] = layer.name
    if before:
        mesh[BEFORE] = before


def is_possible(obj):
    """Whether something is covered, or another map was active."""
    return material.is_covered(obj) or BEFORE in obj.data


def restore(obj):
    """Brings back what was shown before images were baked, or else before maps were made: the materials of all objects
    with this mesh, and the maps that were active; returns whether there was something."""
    return _unbake(obj) or _uncover(obj)


def _unbake(obj):
    found = [material.unbake(user) for user in (obj, *gathering.others(obj))]
    if any(found):
        uv_maps.show_map(obj.data, uv_maps.main_map(obj.data))
    return any(found)


def _uncover(obj):
    mesh = obj.data
    found = [material.uncover(user) for user in (obj, *gathering.others(obj))]
    before = mesh.get(BEFORE)
    if before is None:
        return any(found)
    active, rendered = (mesh.uv_layers.get(before.get(use, "")) for use in ("active", "rendered"))
    if active is not None:
        mesh.uv_layers.active = active
    if rendered is not None:
        rendered.active_render = True
    del mesh[BEFORE]
    return True


def remove_maps(step, obj):
    """Restores, and removes our maps with all that tells of them from the objects with this mesh; returns whether there
    was something. Seams and levels of detail stay."""
    mesh = obj.data
    found = _unbake(obj) | _uncover(obj) | uv_maps.has_maps(mesh) | uv_maps.remove_bake_map(mesh)
    uv_maps.remove_maps(mesh)
    heat.refresh(obj)
    mesh.update()
    for user in (obj, *gathering.others(obj)):
        step.remove(tags.empties_of(user))
        found |= report.remove(user)
        stored_dials.forget(user)
    return found
