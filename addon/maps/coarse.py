# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the texture of a map is much coarser than elsewhere: places with a name, and a vertex for a pole. No bpy."""

from dataclasses import dataclass

import numpy as np

from ..scene.faces import edge_ends

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
    vertex: int  # off the boundary, of the coarsest face that has one


def places(obj, polygons, octaves):
    """The `Place`s of an object's polygons with this `holomorph.distortion.Distortion.density`, the largest first."""
    faces = np.flatnonzero(octaves < OCTAVES)
    if not len(faces):
        return []
    labels, is_inner = _components(polygons, faces), _inner(polygons)
    kinds, counts = np.unique(labels, return_counts=True)
    order = np.argsort(-counts, kind="stable")[:MOST_PLACES]
    kept = kinds[order][counts[order] > LEAST_PART * len(octaves)]
    found = [_place(obj, polygons, octaves, faces[labels == kind], is_inner) for kind in kept]
    return [place for place in found if place is not None]


def _place(obj, polygons, octaves, faces, is_inner):
    """None where all vertices are on the boundary."""
    vertices, _ = _vertices(polygons, faces[np.argsort(octaves[faces], kind="stable")])
    inner = vertices[is_inner[vertices]]
    if not len(inner):
        return None
    return Place(_name(obj, polygons, inner[0]), float(2 ** (-octaves[faces].mean() / 2)), int(inner[0]))


def _vertices(polygons, faces):
    """(vertices of the corners of faces, one face after the other; how many each has)."""
    sizes = np.diff(polygons.face_offsets)[faces]
    ends = np.cumsum(sizes)
    starts = polygons.face_offsets[:-1][faces]
    return polygons.corner_vertices[np.arange(ends[-1]) + np.repeat(starts - (ends - sizes), sizes)], sizes


def _inner(polygons):
    """(#V,) whether a vertex is on no edge of a single face."""
    ends, count = edge_ends(polygons), len(polygons.vertices)
    keys, faces = np.unique(ends[:, 0] * count + ends[:, 1], return_counts=True)
    is_inner = np.ones(count, bool)
    is_inner[np.concatenate(np.divmod(keys[faces == 1], count))] = False
    return is_inner


def _components(polygons, faces):
    """(n,) labels of faces, equal where they are joined by vertices that they share."""
    vertices, sizes = _vertices(polygons, faces)
    starts = np.cumsum(sizes) - sizes
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
