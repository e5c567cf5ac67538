"""Facets, the wide flat places of a surface. A bevel or a rounded edge between two of them is one hard edge, however
little each of its own edges bends."""

import numpy as np

from .cut_open import cut_open
from .hard_edges import angles, bends, faces_of_edges

FLAT = 10.0  # degrees: faces that bend less are of one place
WIDE = 0.06  # width of a place over the root of the area, from which on it is a facet, and no strip between facets
LEVEL = 0.97  # length of the sum of normals over the area, from which on a place is flat as a whole
NARROW = 2.5  # times as wide as a strip beside it a facet is at least; faces of a coarse smooth mesh are alike
STEPS = np.radians([15.0, 30.0, 45.0, 60.0])  # strips go to the facet to which they bend least, in these steps


def breaks(surface):
    """(#E,) radians by which a surface breaks off at an edge: the bend of its two faces, or the angle between the
    facets to both sides, if that is more. Strips between facets are part of that to which they bend less: a bevel is
    one line.

    Source: ours; the limits were chosen on pictures of bevelled props beside smooth and coarse meshes.
    """
    result = bends(surface)
    place = np.asarray(cut_open(surface, result > np.radians(FLAT))._native.face_component)
    edges, *sides = faces_of_edges(surface)
    is_between = place[sides[0]] != place[sides[1]]
    edges, sides = edges[is_between], np.stack([place[side[is_between]] for side in sides])
    if not len(edges):
        return result
    normals, areas = _of_places(surface, place)
    lengths = np.asarray(surface._native.edge_lengths)[edges]
    around = np.bincount(sides.ravel(), np.tile(lengths, 2), len(areas))
    width = 2 * areas / np.where(around > 0, around, np.inf)
    is_facet = (width >= WIDE * np.sqrt(areas.sum())) & (np.linalg.norm(normals, axis=1) >= LEVEL * areas)
    facet = np.where(is_facet, np.arange(len(areas)), -1)
    one, other = _with_strips(facet, sides, result[edges], width)[sides]
    is_break = (one != other) & (one >= 0) & (other >= 0)
    edges = edges[is_break]
    result[edges] = np.maximum(result[edges], angles(normals[one[is_break]], normals[other[is_break]]))
    return result


def _of_places(surface, place):
    """((n, 3) normals, (n,) areas) of places that faces are of."""
    a, b, c = np.moveaxis(surface.vertices[surface.triangles], 1, 0)
    cross, at, count = np.cross(b - a, c - a) / 2, place[surface.triangle_faces], place.max() + 1
    normals = np.stack([np.bincount(at, column, count) for column in cross.T], axis=1)
    return normals, np.bincount(at, np.linalg.norm(cross, axis=1), count)


def _with_strips(facet, sides, bent, width):
    """(n,) the facet of each place, -1 without: of strips, where `facet` is -1, that of a neighbour."""
    to, come, bent = np.concatenate(sides), np.concatenate(sides[::-1]), np.tile(bent, 2)
    facet = facet.copy()
    for most in STEPS:
        while (
            is_next := (facet[to] < 0)
            & (facet[come] >= 0)
            & (bent <= most)
            & (NARROW * width[to] <= width[facet[come]])
        ).any():
            pairs = np.flatnonzero(is_next)
            pairs = pairs[np.lexsort((facet[come[pairs]], bent[pairs]))]
            strips, first = np.unique(to[pairs], return_index=True)
            facet[strips] = facet[come[pairs[first]]]
    return facet
