# SPDX-License-Identifier: GPL-3.0-or-later
"""How a UV map distorts a mesh, polygon by polygon, and the colours that show it. Arrays only, no bpy.

Any UV map and any mesh will do: nothing is solved, and the mesh need not be a surface that can be.
"""

from dataclasses import dataclass

import numpy as np

MOST_OCTAVES = 16.0  # a density beyond is one of a collapsed polygon
MOST_ANGLE = 1e3  # likewise
LOW, HIGH = 0.05, 0.95  # quantiles of the density whose ratio is reported


@dataclass(frozen=True, eq=False)
class Distortion:
    """s1 >= s2 are the singular values of the map of each triangle; a polygon has the mean of its triangles by area.

    Finite everywhere: polygons without area have the density of the median and angle 1.
    """

    density: np.ndarray  # (#F,) log2 of UV area per surface area (s1 s2) over its median by area
    angle: np.ndarray  # (#F,) s1 / s2
    density_ratio: float  # 95 % over 5 % quantile of the density, by area
    mean_angle: float  # of the polygons that have not collapsed, by area

    @property
    def density_text(self):
        """The density ratio in few characters."""
        return f"{self.density_ratio:.0f}" if self.density_ratio >= 100 else f"{self.density_ratio:.3g}"


def fans(face_offsets):
    """((#T, 3) corners, (#T,) polygon) of the triangles between the first corner of a polygon and the others."""
    counts = np.diff(face_offsets) - 2
    polygon = np.repeat(np.arange(len(counts)), counts)
    first = np.cumsum(counts) - counts
    step = np.arange(len(polygon)) - first[polygon] + 1
    start = face_offsets[:-1][polygon]
    return np.stack([start, start + step, start + step + 1], axis=1), polygon


def measure(polygons, uv):
    """The `Distortion` of a (#C, 2) map of `mesh_io.Polygons`."""
    corners, polygon = fans(polygons.face_offsets)
    g11, g12, g22, area = _metric(polygons.vertices[polygons.corner_vertices[corners]])
    h11, h12, h22, uv_area = _metric(uv.astype(np.float64)[corners])
    count = polygons.face_count
    face_area, face_uv = (np.bincount(polygon, values, count) for values in (area, uv_area))
    with np.errstate(divide="ignore", invalid="ignore"):
        half = (g22 * h11 - 2 * g12 * h12 + g11 * h22) / (8 * area * uv_area)  # (s1 / s2 + s2 / s1) / 2
        angle = np.where(area > 0, half + np.sqrt(np.clip(half**2 - 1, 0, None)), 1)
        angle = np.clip(np.nan_to_num(angle, nan=MOST_ANGLE, posinf=MOST_ANGLE), 1, MOST_ANGLE)
        angle = np.where(face_area > 0, np.bincount(polygon, area * angle, count) / face_area, 1)
        density = np.where(face_area > 0, face_uv / face_area, np.nan)
        low, median, high = _quantiles(density, face_area, (LOW, 0.5, HIGH))
        octaves = np.clip(np.nan_to_num(np.log2(density / median), nan=0.0), -MOST_OCTAVES, MOST_OCTAVES)
    kept = angle < MOST_ANGLE
    mean = np.average(angle[kept], weights=face_area[kept]) if face_area[kept].any() else 1.0
    return Distortion(octaves, angle, float(high / low) if low > 0 else np.inf, float(mean))


def length_ratio(polygons, uv):
    """UV length for a length on the surface, where the density is the median one by area; 0 where there is no area."""
    corners, polygon = fans(polygons.face_offsets)
    count = polygons.face_count
    points = polygons.vertices[polygons.corner_vertices[corners]], uv.astype(np.float64)[corners]
    area, uv_area = (np.bincount(polygon, _metric(of_kind)[-1], count) for of_kind in points)
    has_area = area > 0
    (median,) = _quantiles(uv_area[has_area] / area[has_area], area[has_area], (0.5,))
    return float(np.sqrt(median))


def _metric(points):
    """Inner products of two sides of (#T, 3, d) triangles, and the areas."""
    first, second = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    a, b, c = (np.einsum("ij,ij->i", x, y) for x, y in ((first, first), (first, second), (second, second)))
    return a, b, c, 0.5 * np.sqrt(np.clip(a * c - b * b, 0, None))


def _quantiles(values, weights, shares):
    """The values below which these shares of the weights lie; 0 where nothing has weight."""
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    if not len(total) or total[-1] <= 0:
        return [0.0] * len(shares)
    return [values[order[np.searchsorted(total, share * total[-1])]] for share in shares]


@dataclass(frozen=True)
class Scale:
    """The colours of a quantity along a bar, and what is written beside them."""

    stops: tuple  # sRGB, evenly along the bar
    ticks: tuple  # (place, text)

    def colours(self, places):
        """(n, 3) float32 sRGB at places on the bar; places beyond its ends are moved there."""
        at = np.linspace(0, 1, len(self.stops))
        return np.stack([np.interp(places, at, channel) for channel in np.transpose(self.stops)], -1).astype(np.float32)


OCTAVES_SHOWN = 4.0  # on either side of the median

DENSITY = Scale(
    ((0.13, 0.27, 0.60), (0.40, 0.62, 0.80), (0.90, 0.89, 0.86), (0.93, 0.60, 0.36), (0.66, 0.13, 0.14)),
    ((0.0, "1/16"), (0.25, "1/4"), (0.5, "median"), (0.75, "4"), (1.0, "16")),
)
ANGLE = Scale(
    ((0.90, 0.89, 0.86), (0.95, 0.80, 0.45), (0.91, 0.47, 0.28), (0.68, 0.16, 0.35), (0.28, 0.05, 0.33)),
    ((0.0, "1"), (0.316, "1.1"), (0.548, "1.3"), (0.775, "1.6"), (1.0, "2")),
)


def density_places(octaves):
    return 0.5 + octaves / (2 * OCTAVES_SHOWN)


def angle_places(angle):
    """The root shows small distortions well: most are small."""
    return np.sqrt(np.clip(angle - 1, 0, 1))
