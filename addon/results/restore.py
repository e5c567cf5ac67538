# SPDX-License-Identifier: GPL-3.0-or-later
"""What an object showed before its maps were made: its materials, and the active UV maps of its mesh."""

from ..materials import material
from ..scene import gathering, stored_dials, uv_maps
from . import heat, report, tags


def is_possible(obj):
    """Whether something is covered, or another map was active."""
    return material.is_covered(obj) or uv_maps.BEFORE in obj.data


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
    found = [material.uncover(user) for user in (obj, *gathering.others(obj))]
    return uv_maps.show_remembered(obj.data) or any(found)


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
