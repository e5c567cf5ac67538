"""How a UV map distorts a mesh, polygon by polygon.

Any UV map and any mesh will do: nothing is solved, and the mesh need not be a surface that can be. `Quality` measures
triangles of surfaces.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import NamedTuple, Protocol

import numpy as np

from .. import _native
from ..core.array_types import Integers, Reals

MOST_OCTAVES = _native.most_octaves  # a density beyond is one of a collapsed polygon
COLLAPSED = _native.collapsed_angle  # s1 / s2 of a collapsed polygon


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
