"""The maps of a mesh's parts side by side in the UV plane, at one texel density."""

import cmath
import math

import numpy as np

from ..layout import pack, rows
from ..placement import frame

CENTRE = 0.5 + 0.5j  # the middle of the UV square


def main_uv(surface, parts, maps):
    """(#C, 2) of the whole surface: tilings from (0, 0) on, moved by whole units only; then the other parts, which fill
    the UV square where there is no tiling. Corners of parts without a map are 0."""
    uv = np.zeros((len(surface.corner_vertices), 2))
    done = [part for part in parts if part.map is not None]
    tiled, rest = [part for part in done if part.map.tiling], [part for part in done if not part.map.tiling]
    right = _place_tilings(uv, surface, tiled)
    if rest:
        unit = float(np.median([part.map.unit_length for part in tiled])) if tiled else None
        placed, side = _packed(rest, [part.map.uv for part in rest], maps, unit)
        shift = right + maps.margin * side + side / 2 - CENTRE.real if tiled else 0.0
        for part, values in zip(rest, placed):
            uv[_corners(surface, part)] = values + [shift, 0.0]
    return uv


def form_uvs(surface, parts, maps):
    """(#C, 2) for each form that gets a map of its own; parts that lack the form are 0 there."""
    done = [part for part in parts if part.map is not None]
    counts = [len(part.structure.balanced_coefficients()) for part in done]
    for form in range(min(maps.forms, max(counts, default=0))):
        having = [part for part, count in zip(done, counts) if form < count]
        uv = np.zeros((len(surface.corner_vertices), 2))
        raw = [part.structure.uv(_unit(part, form)) for part in having]
        for part, values in zip(having, _packed(having, raw, maps)[0]):
            uv[_corners(surface, part)] = values
        yield uv


def _unit(part, form):
    balanced = np.asarray(part.structure.balanced_coefficients())
    return np.eye(len(balanced), dtype=balanced.dtype)[form]


def _corners(surface, part):
    """The part's corners among those of the surface; both tell where a corner is in the file, in its order."""
    return np.searchsorted(surface.corner_index, part.surface.corner_index)


def _place_tilings(uv, surface, tiled):
    """Writes the tilings on shelves of whole units; returns where they end on the right."""
    if not tiled:
        return 0.0
    lows = [np.floor(part.map.uv.min(axis=0)) for part in tiled]
    sizes = np.array([np.ceil(part.map.uv.max(axis=0)) - low for part, low in zip(tiled, lows)])
    width = max(math.ceil(math.sqrt(np.prod(sizes, axis=1).sum())), sizes[:, 0].max())
    corners, whole = rows(sizes, width, 0.0)
    for part, low, corner in zip(tiled, lows, corners):
        uv[_corners(surface, part)] = part.map.uv + (corner - low)
    return float(math.ceil(whole[0]))


def _packed(parts, raw, maps, unit_length=None):
    """The maps of parts, packed around the middle of the UV square, and the side of their square: `maps.density`, or
    where a UV unit is to have the length `unit_length`, as large as that asks for."""
    rotation = math.radians(maps.rotation)
    frames = [frame(part.surface, uv, rotation) for part, uv in zip(parts, raw)]
    scales = [math.sqrt(p.surface.area / f.area) if f.area > 0 else 0.0 for p, f in zip(parts, frames)]
    sizes = [[s * (f.high - f.low).real, s * (f.high - f.low).imag] for s, f in zip(scales, frames)]
    corners, side = pack(sizes, maps.margin)
    fit = maps.density / side if side > 0 else 0.0
    if unit_length is not None:
        fit = 1 / unit_length if unit_length > 0 else 0.0
    middle, turn = complex(side, side) / 2, cmath.exp(1j * rotation)
    placed = []
    for uv, s, f, corner, size in zip(raw, scales, frames, corners, sizes):
        z = uv[:, 0] + 1j * uv[:, 1]
        target = CENTRE + fit * (complex(*corner) + complex(*size) / 2 - middle)
        z = fit * s * (z * turn - (f.low + f.high) / 2) + target
        placed.append(np.stack([z.real, z.imag], axis=1))
    return placed, fit * side
