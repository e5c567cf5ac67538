# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the texture of a map is much coarser than elsewhere: places with a name, and a vertex for a pole. No bpy."""

from dataclasses import dataclass

import numpy as np

from . import distortion

OCTAVES = -4.0  # of the density in area, from which on a face is coarse: lengths four times the median
LEAST_PART = 0.002  # of all faces, in a place that is named
MOST_PLACES = 8
MOST_TIMES = 200  # beyond, the number does not matter
SIDES = (("the -X side", "the +X side"), ("the front", "the back"), ("the bottom", "the top"))  # of an object


@dataclass(frozen=True)
class Place:
    """Faces that are coarse and hang together."""

    name: str
    times: float  # a length of the texture there, in its median length elsewhere
    vertex: int  # of the coarsest face


def places(obj, polygons, uv):
    """The `Place`s of an object's polygons under (#C, 2) UVs, the largest first."""
    octaves = distortion.measure(polygons.vertices, polygons.corner_vertices, polygons.face_offsets, uv).density
    faces = np.flatnonzero(octaves < OCTAVES)
    if not len(faces):
        return []
    labels = _components(polygons, faces)
    kinds, counts = np.unique(labels, return_counts=True)
    order = np.argsort(-counts, kind="stable")[:MOST_PLACES]
    kept = kinds[order][counts[order] > LEAST_PART * len(octaves)]
    return [_place(obj, polygons, octaves, faces[labels == kind]) for kind in kept]


def _place(obj, polygons, octaves, faces):
    corner = polygons.face_offsets[faces[np.argmin(octaves[faces])]]
    vertex = int(polygons.corner_vertices[corner])
    return Place(_name(obj, polygons, vertex), float(2 ** (-octaves[faces].mean() / 2)), vertex)


def _components(polygons, faces):
    """(n,) labels of faces, equal where they are joined by vertices that they share."""
    sizes = np.diff(polygons.face_offsets)[faces]
    ends = np.cumsum(sizes)
    starts = ends - sizes
    corners = np.arange(ends[-1]) + np.repeat(polygons.face_offsets[:-1][faces] - starts, sizes)
    vertices = polygons.corner_vertices[corners]
    labels = np.arange(len(polygons.vertices))
    while True:  # labels only fall, and halve their distance to the lowest one in each round
        lowest = np.repeat(np.minimum.reduceat(labels[vertices], starts), sizes)
        lower = labels.copy()
        np.minimum.at(lower, vertices, lowest)
        lower = lower[lower]
        if np.array_equal(lower, labels):
            return labels[vertices[starts]]
        labels = lower


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
