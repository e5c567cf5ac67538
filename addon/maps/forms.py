# SPDX-License-Identifier: GPL-3.0-or-later
"""UV maps of forms out of a solve: coefficients, dials, and the parts side by side in the UV square. No bpy here.

All parts of a map have the same texel density (UV area in proportion to surface area), and at density 1 they fill the
square from 0 to 1 together. Nothing here needs a new solve.
"""

import cmath
import math
from dataclasses import dataclass

import numpy as np

from .. import native

SQUARES_ACROSS = 32  # along the diagonal of the bounding box, where the density is the median one
SQUARES_LIMIT = 10_000
CENTRE = 0.5 + 0.5j  # the middle of the UV square


@dataclass(frozen=True)
class Place:
    """Position of a part in the UV square: it is multiplied by `factor`, `origin` is moved to `target`."""

    factor: complex
    origin: complex
    target: complex


def values(solved, index, options):
    """(#C,2) float32: the main map for index 0, else that of a form."""
    write, parts = native.load().place, _parts(solved, index)
    whole = len(parts) == 1 and parts[0].surface.is_whole  # then every row is written
    placed = (np.empty if whole else np.zeros)((len(solved.polygons.corner_vertices), 2))
    raw = [_raw(part, index, options) for part in parts]
    for part, uv, place in zip(parts, raw, _places(parts, index, options, raw)):
        if index == 0:
            main_map(part, options, uv)
        # The two copies of a seam edge stay equal to the last bits, and so does v along a straight boundary.
        rows = None if part.surface.is_whole else part.surface.corner_index
        write(uv, place.factor, place.origin, place.target, placed, rows)
    return placed.astype(np.float32)


def shape_points(solved):
    """(#V,3) conformal images of the parts that have one, zeros elsewhere; None if no part has one.

    Spheres go to the unit sphere, disks to the unit disk in the plane z = 0.
    """
    points, found = np.zeros((len(solved.polygons.vertices), 3)), False
    for part in solved.done:
        own = _shape(part)
        if own is not None:
            points[part.surface.vertex_index] = own[part.surface.vertex_index]
            found = True
    return points if found else None


def _shape(part):
    """(#V,3) of all vertices of the mesh, NaN at those of other parts; None for a part that has no such image."""
    structure, is_planar = part.structure, part.surface.genus == 0
    if is_planar and part.surface.boundary_count == 0 and len(structure.poles) == 2:
        return structure.sphere_map()
    if is_planar and part.surface.boundary_count == 1 and structure.map_kind == "disk":
        disk = structure.disk_map()
        return np.stack([disk.real, disk.imag, 0 * disk.real], axis=1)
    return None


def _parts(solved, index):
    return [c for c in solved.done if index == 0 or index <= c.form_count]


def coefficients(component, index, options):
    """The balanced combination with its dials for index 0, else the unit of form `index`.

    Real where the balanced ones are: a complex factor would bend the straight boundaries.
    """
    balanced = np.asarray(component.balanced)
    if index > 0:
        return np.eye(component.form_count, dtype=balanced.dtype)[index - 1]
    dials = np.array(options.amounts, float)
    if np.iscomplexobj(balanced):
        dials = dials * np.exp(1j * np.array(options.turns))
    result = balanced.copy()
    shared = min(len(result), len(dials))
    result[:shared] *= dials[:shared]
    return result


def _raw(component, index, options):
    """(#C of the component, 2) UVs as the library gives them."""
    return component.structure.uv(coefficients(component, index, options))


def _frame(component, index, options, uv=None):
    """The frame of a map of one part, rotated but not scaled; cached."""
    dials = (options.amounts, options.turns) if index == 0 else ()
    key = (index, options.rotation, dials)
    if key not in component.frames:
        uv = _raw(component, index, options) if uv is None else uv
        component.frames[key] = native.load().frame(component.surface, uv, options.rotation)
    return component.frames[key]


def _places(parts, index, options, raw=None):
    """A `Place` for each part. Where a map has no area, as with all dials at zero, the part shrinks to a point."""
    frames = [_frame(part, index, options, uv) for part, uv in zip(parts, raw or [None] * len(parts))]
    scales, sizes, corners, side = _packed(parts, frames, options)
    fit = options.density * (options.per_length or 1 / side) if side > 0 else 0.0
    middle = complex(side, side) / 2
    return [
        Place(
            fit * scale * cmath.exp(1j * options.rotation),
            (frame.low + frame.high) / 2 * cmath.exp(-1j * options.rotation),
            CENTRE + fit * (complex(*corner) + complex(*size) / 2 - middle),
        )
        for scale, frame, corner, size in zip(scales, frames, corners, sizes)
    ]


def _packed(parts, frames, options):
    """(factors, sizes, lower left corners, side of the whole) of the parts with the areas that they have in space."""
    scales = [math.sqrt(part.area / frame.area) if frame.area > 0 else 0.0 for part, frame in zip(parts, frames)]
    sizes = [[s * (f.high - f.low).real, s * (f.high - f.low).imag] for s, f in zip(scales, frames)]
    return scales, sizes, *native.load().layout.pack(sizes, options.margin)


def filling(solved, options):
    """`options.MapOptions.per_length` with which the main map fills the UV square; infinite for one without area."""
    parts = _parts(solved, 0)
    side = _packed(parts, [_frame(part, 0, options) for part in parts], options)[-1]
    return 1 / side if side > 0 else math.inf


@dataclass(frozen=True)
class MainMap:
    """What is cached of the main map; scale and rotation do not matter."""

    report: dict  # `holomorph.report.map_report`
    length_ratio: float  # UV length per length on the surface, the median by area, as the library gives the map


def main_map(component, options, uv=None):
    """The `MainMap` of a component, cached for each setting of its dials."""
    dials = (options.amounts, options.turns)
    if dials not in component.main_maps:
        uv = _raw(component, 0, options) if uv is None else uv
        keep_main_map(component, options, component.structure.quality(uv))
    return component.main_maps[dials]


def keep_main_map(component, options, quality):
    """Caches the `MainMap` of a `holomorph.Quality`."""
    report = native.load().report.map_report(coefficients(component, 0, options), quality)
    found = MainMap(report, math.sqrt(quality.median_density))
    component.main_maps[options.amounts, options.turns] = found


def squares_that_fit(solved, options):
    """Checker squares per UV unit so that about `SQUARES_ACROSS` of them span the largest part that has a map, an even
    number."""
    size, unit = _largest(solved, options)
    return min(max(2 * round(SQUARES_ACROSS * unit / size / 2), 2), SQUARES_LIMIT) if unit > 0 else SQUARES_ACROSS


def unit_length(solved, options):
    """The length on the surface of a UV unit, where the density is the median one; 0 for a map without area."""
    return _largest(solved, options)[1]


def _largest(solved, options):
    """(diagonal, `unit_length`) of the largest part that has a map."""
    sizes = [_diagonal(c.surface.vertices) for c in solved.done]
    largest = int(np.argmax(sizes))
    part, place = solved.done[largest], _places(solved.done, 0, options)[largest]
    density = abs(place.factor) * main_map(part, options).length_ratio
    return sizes[largest], 1 / density if density > 0 else 0.0


def _diagonal(points):
    """The bounding box's diagonal; NumPy finds ranges of single columns much faster than of all at once."""
    return math.hypot(*(float(np.ptp(column)) for column in points.T))
