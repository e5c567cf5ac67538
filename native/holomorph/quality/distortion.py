"""How a UV map distorts a mesh, polygon by polygon, and where its texture is much coarser than elsewhere.

Any UV map and any mesh will do: nothing is solved, and the mesh need not be a surface that can be. `Quality` measures
triangles of surfaces.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import NamedTuple, Protocol

import numpy as np

from .. import _native
from ..core.array_types import Integers, Reals
from ..mesh import edges

MOST_OCTAVES = _native.most_octaves  # a density beyond is one of a collapsed polygon
COLLAPSED = _native.collapsed_angle  # s1 / s2 of a collapsed polygon
OCTAVES = -4.0  # octaves of the density in area, from which on a face is coarse: lengths four times the median
LEAST_PART = 0.002  # part of all faces in a place that counts
MOST_PLACES = 8


class Polygons(Protocol):
    """A `Surface` with positions, or any other polygons: (#V, 3) positions, (#C,) vertex of each corner, (#F + 1,)
    first corner of each polygon."""

    vertices: Reals
    corner_vertices: Integers
    face_offsets: Integers


@dataclass(frozen=True, eq=False)
class Distortion:
    """s1 >= s2 are the singular values of the map of each triangle; a polygon has the mean of its triangles by area.

    Finite everywhere: polygons without area have the density of the median and angle 1, and those that are not steep
    the direction 0.
    """

    density: Reals  # (#F,) log2 of UV area per surface area (s1 s2) over its median by area
    angle: Reals  # (#F,) s1 / s2
    size_range: float  # of the sides of squares: root of the 95 % over 5 % quantile of the density, by area
    mean_angle: float  # by area, each polygon with 10 at most
    direction: Reals  # (#F,) degrees between the gradient of v and what is up, see `Direction`
    upright_part: float  # of the steep area

    @property
    def size_text(self) -> str:
        """The size range in few characters."""
        return f"{self.size_range:.0f}" if self.size_range >= 100 else f"{self.size_range:.3g}"


class WorstPlace(NamedTuple):
    """Where a map is worst in one respect."""

    face: int
    position: tuple[float, ...]  # mean of the polygon's corners
    value: float


def fans(face_offsets: Integers) -> tuple[Integers, Integers]:
    """((#T, 3) corners, (#T,) polygon) of the triangles between the first corner of a polygon and the others."""
    counts = np.diff(face_offsets) - 2
    polygon = np.repeat(np.arange(len(counts)), counts)
    first = np.cumsum(counts) - counts
    step = np.arange(len(polygon)) - first[polygon] + 1
    start = face_offsets[:-1][polygon]
    return np.stack([start, start + step, start + step + 1], axis=1), polygon


def measure(mesh: Polygons, uv: Reals, up: str = "Z") -> Distortion:
    """The `Distortion` of a (#C, 2) map of the mesh's polygon corners. up : the axis that points up, "Y" or "Z"."""
    found = _native.distortion(*_arrays(mesh), uv, up)
    return Distortion(*(getattr(found, field.name) for field in fields(Distortion)))


def _arrays(mesh):
    return mesh.vertices, mesh.corner_vertices, mesh.face_offsets


def worst_places(mesh: Polygons, uv: Reals, poles: Integers) -> dict[str, WorstPlace]:
    """The polygons of a (#C, 2) map that an eye finds first, apart from those at poles (vertices): "largest" and
    "smallest" squares, whose value is a side over that at the median density, and "sheared" ones, s1 / s2. Empty where
    all polygons are at poles."""
    starts = mesh.face_offsets[:-1]
    kept = np.flatnonzero(~np.logical_or.reduceat(np.isin(mesh.corner_vertices, poles), starts))
    if not len(kept):
        return {}
    found = measure(mesh, uv)
    side, angle = 2.0 ** (-found.density[kept] / 2), found.angle[kept]
    places = {}
    for name, values, at in (
        ("largest", side, side.argmax()),
        ("smallest", side, side.argmin()),
        ("sheared", angle, angle.argmax()),
    ):
        face = int(kept[at])
        corners = mesh.corner_vertices[mesh.face_offsets[face] : mesh.face_offsets[face + 1]]
        position = tuple(mesh.vertices[corners].mean(axis=0).tolist())
        places[name] = WorstPlace(face, position, float(values[at]))
    return places


def drawn_density(mesh: Polygons, uv: Reals) -> float:
    """UV area per surface area: the median by area over the triangles that are drawn; 0 where there is no area."""
    return _native.drawn_density(*_arrays(mesh), uv)


def length_ratio(mesh: Polygons, uv: Reals) -> float:
    """UV length for a length on the surface, where the density is the median one; 0 where there is no area."""
    return drawn_density(mesh, uv) ** 0.5


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
    ends, count = np.sort(edges.polygon_sides(mesh), axis=1), len(mesh.vertices)
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
