"""Places where the texture of a map is much coarser than elsewhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.array_types import Integers, Reals
from ..mesh.edges import polygon_sides
from .distortion import Polygons

OCTAVES = -4.0  # octaves of the density in area, from which on a face is coarse: lengths four times the median
LEAST_PART = 0.002  # part of all faces in a place that counts
MOST_PLACES = 8


@dataclass(frozen=True)
class CoarsePlace:
    """Coarse faces that hang together.

    times : a length of the texture there, in its median length elsewhere
    vertex : off the boundary, of the coarsest face that has one
    """

    times: float
    vertex: int


def coarse_places(mesh: Polygons, density: Reals) -> list[CoarsePlace]:
    """Finds the coarse places of a mesh with this `distortion.Distortion.density`, (#F,), the largest first; without
    those whose vertices all lie on the boundary. O(#C log #C).

    Raises IndexError for fewer densities than faces.
    Source: ours; the limits were chosen on pictures.

    Examples
    --------
    >>> x, y = np.mgrid[0:9, 0:9]
    >>> corner = (9 * x + y)[:-1, :-1].ravel()
    >>> faces = np.stack([corner, corner + 9, corner + 10, corner + 1], axis=1)
    >>> sheet = holomorph.Surface(np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3), faces)
    >>> density = np.where(np.isin(np.arange(64), [27, 28, 35, 36]), -6.0, 0.0)  # four faces in the middle
    >>> print(holomorph.coarse_places(sheet, density))
    [CoarsePlace(times=8.0, vertex=30)]
    """
    faces = np.flatnonzero(density < OCTAVES)
    if not len(faces):
        return []
    labels, is_inner = _components(mesh, faces), _inner(mesh)
    kinds, counts = np.unique(labels, return_counts=True)
    order = np.argsort(-counts, kind="stable")[:MOST_PLACES]
    kept = kinds[order][counts[order] > LEAST_PART * len(density)]
    found = [_place(mesh, density, faces[labels == kind], is_inner) for kind in kept]
    return [place for place in found if place is not None]


def _place(mesh, density, faces, is_inner):
    vertices, _ = _vertices(mesh, faces[np.argsort(density[faces], kind="stable")])
    inner = vertices[is_inner[vertices]]
    return CoarsePlace(float(2 ** (-density[faces].mean() / 2)), int(inner[0])) if len(inner) else None


def _vertices(mesh, faces):
    """(vertices of the corners of faces, one face after the other; how many each has)."""
    sizes = np.diff(mesh.face_offsets)[faces]
    ends = np.cumsum(sizes)
    starts = mesh.face_offsets[:-1][faces]
    return mesh.corner_vertices[np.arange(ends[-1]) + np.repeat(starts - (ends - sizes), sizes)], sizes


def _inner(mesh):
    """(#V,) whether a vertex is on no edge of a single face."""
    ends, count = np.sort(polygon_sides(mesh), axis=1), len(mesh.vertices)
    keys, faces = np.unique(ends[:, 0] * count + ends[:, 1], return_counts=True)
    is_inner = np.ones(count, bool)
    is_inner[np.concatenate(np.divmod(keys[faces == 1], count))] = False
    return is_inner


def _components(mesh, faces) -> Integers:
    """(n,) labels of faces, equal where they are joined by vertices that they share."""
    vertices, sizes = _vertices(mesh, faces)
    starts = np.cumsum(sizes) - sizes
    labels = np.arange(len(mesh.vertices))
    while True:  # labels only fall, and halve their distance to the lowest one in each round
        lowest = np.repeat(np.minimum.reduceat(labels[vertices], starts), sizes)
        lower = labels.copy()
        np.minimum.at(lower, vertices, lowest)
        lower = lower[lower]
        if np.array_equal(lower, labels):
            return labels[vertices[starts]]
        labels = lower
