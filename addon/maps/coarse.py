# SPDX-License-Identifier: GPL-3.0-or-later
"""Names and words for where the texture of a map is much coarser than elsewhere. No bpy."""

import numpy as np

from ..native import holomorph

MOST_TIMES = 200  # beyond, the number does not matter
SIDES = (("the -X side", "the +X side"), ("the front", "the back"), ("the bottom", "the top"))  # of an object


def places(obj, polygons, density):
    """The `holomorph.coarse_places` of an object as entries of a report, each with a name."""
    found = holomorph.coarse_places(polygons, density)
    return [{"name": _name(obj, polygons, place.vertex), **vars(place)} for place in found]


def _name(obj, polygons, vertex):
    """The vertex group that is strongest at a vertex; without groups, where the vertex lies on the object."""
    groups = [group for group in obj.data.vertices[vertex].groups if group.weight > 0]
    if groups:
        return obj.vertex_groups[max(groups, key=lambda group: group.weight).group].name
    size = np.maximum(np.ptp(polygons.vertices, axis=0), np.finfo(float).tiny)
    offset = (polygons.vertices[vertex] - polygons.vertices.mean(axis=0)) / size
    axis = int(np.argmax(np.abs(offset)))
    return SIDES[axis][int(offset[axis] > 0)]


def sentence(found):
    """Such as "the top and 3 more places are 40 times coarser than the rest"; of places in a report."""
    names = list(dict.fromkeys(place["name"] for place in found))
    others = len(found) - 1
    words = names[0] if others == 0 else f"{names[0]} and {others} more place{'s' if others > 1 else ''}"
    if len(found) == 2 and len(names) == 2:
        words = f"{names[0]} and {names[1]}"
    times = max(place["times"] for place in found)
    factor = f"{times:.0f}" if times < MOST_TIMES else f"over {MOST_TIMES}"
    text = f"{words} {'is' if others == 0 else 'are'} {factor} times coarser than the rest"
    return text[0].upper() + text[1:]
