"""How a UV map distorts a mesh, polygon by polygon.

Any UV map and any mesh will do: nothing is solved, and the mesh need not be a surface that can be. `Quality` measures
triangles of surfaces.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from ..core.array_types import Integers, Reals
from .direction import UPRIGHT, turned

MOST_OCTAVES = 16.0  # a density beyond is one of a collapsed polygon
COLLAPSED = 1e3  # s1 / s2 of a collapsed polygon
MOST_ANGLE = 10.0  # what s1 / s2 counts at most in its mean, so that no single triangle decides it; as in uv/quality.h
LOW, HIGH = 0.05, 0.95  # quantiles of the density whose ratio is reported


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
    mean_angle: float  # by area, each polygon with `MOST_ANGLE` at most
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
    corners, polygon = fans(mesh.face_offsets)
    points, at = mesh.vertices[mesh.corner_vertices[corners]], uv.astype(np.float64)[corners]
    g11, g12, g22, area = _metric(points)
    h11, h12, h22, uv_area = _metric(at)
    count = len(mesh.face_offsets) - 1
    face_area, face_uv = (np.bincount(polygon, values, count) for values in (area, uv_area))
    with np.errstate(divide="ignore", invalid="ignore"):
        half = (g22 * h11 - 2 * g12 * h12 + g11 * h22) / (8 * area * uv_area)  # (s1 / s2 + s2 / s1) / 2
        angle = np.where(area > 0, half + np.sqrt(np.clip(half**2 - 1, 0, None)), 1)
        angle = np.clip(np.nan_to_num(angle, nan=COLLAPSED, posinf=COLLAPSED), 1, COLLAPSED)
        angle = np.where(face_area > 0, np.bincount(polygon, area * angle, count) / face_area, 1)
        density = np.where(face_area > 0, face_uv / face_area, np.nan)
        low, median, high = quantiles(density, face_area, (LOW, 0.5, HIGH))
        octaves = np.clip(np.nan_to_num(np.log2(density / median), nan=0.0), -MOST_OCTAVES, MOST_OCTAVES)
    mean = np.average(np.minimum(angle, MOST_ANGLE), weights=face_area) if face_area.any() else 1.0
    size_range = float(np.sqrt(high / low)) if low > 0 else np.inf
    return Distortion(octaves, angle, size_range, float(mean), *_direction(points, at, up, polygon, count))


def _direction(points, uv, up, polygon, count):
    """`Distortion.direction` and `upright_part` of triangles, of these of `count` polygons."""
    degrees, area, is_steep = turned(points, uv, up)
    steep = area * is_steep
    of_face = np.bincount(polygon, steep, count)
    with np.errstate(divide="ignore", invalid="ignore"):
        direction = np.where(of_face > 0, np.bincount(polygon, steep * degrees, count) / of_face, 0.0)
    return direction, float(np.average(degrees < UPRIGHT, weights=steep)) if steep.any() else 1.0


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


def drawn_densities(mesh: Polygons, uv: Reals) -> tuple[float, float, float]:
    """UV area per surface area: its 5 %, 50 % and 95 % quantile by area over the triangles that are drawn, `fans`; 0
    where there is no area."""
    corners, _ = fans(mesh.face_offsets)
    area = _metric(mesh.vertices[mesh.corner_vertices[corners]])[-1]
    uv_area = _metric(uv.astype(np.float64)[corners])[-1]
    has_area = area > 0
    low, median, high = quantiles(uv_area[has_area] / area[has_area], area[has_area], (LOW, 0.5, HIGH))
    return float(low), float(median), float(high)


def length_ratio(mesh: Polygons, uv: Reals) -> float:
    """UV length for a length on the surface, where the density is the median one; 0 where there is no area."""
    return drawn_densities(mesh, uv)[1] ** 0.5


def _metric(points):
    """The inner products of two sides of (#T, 3, d) triangles, and their areas."""
    first, second = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    a, b, c = (np.einsum("ij,ij->i", x, y) for x, y in ((first, first), (first, second), (second, second)))
    return a, b, c, 0.5 * np.sqrt(np.clip(a * c - b * b, 0, None))


def quantiles(values: Reals, weights: Reals, shares: Sequence[float]) -> list[float]:
    """The values below which these shares of the weights lie; 0 where nothing has weight."""
    order = np.argsort(values, kind="stable")
    total = np.cumsum(weights[order])
    if not len(total) or total[-1] <= 0:
        return [0.0] * len(shares)
    return [values[order[np.searchsorted(total, share * total[-1])]] for share in shares]
