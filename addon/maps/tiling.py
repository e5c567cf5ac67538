# SPDX-License-Identifier: GPL-3.0-or-later
"""Seamless tilings of the parts of a solve, and their place in the UV plane. No bpy here: it runs in a worker thread.

UVs are moved by whole units, turned by quarters, and rounded to a grid that float32 holds exactly: so the sides of a
cut differ by whole units to the last bit.
"""

import math
from dataclasses import replace

import numpy as np

from .. import native

PLACING_SHARE = 0.6  # of the work on a tiling, for finding the poles
MANTISSA = 24  # bits of a float32
QUARTER = np.array([[0, 1], [-1, 0]])  # rows times it: a quarter turn counter-clockwise


def tile(component, options, progress=None):
    """The `holomorph.Tiling` of a part by its own `TileOptions`. What it rounded last is not rounded again for poles
    that are dragged."""
    scaled = native.load().progress.scaled
    tiler = component.structure.tiler(
        options.poles if isinstance(options.poles, (str, int)) else list(options.poles),
        boundary=options.boundary,
        allowed=None if options.allowed is None else np.frombuffer(options.allowed, bool),
        surface=component.surface,
        progress=scaled(progress, 0.0, PLACING_SHARE),
    )
    rounded = replace(options, moved=())
    asked, made = component.last_rounded.get(tiler, (None, None))
    if not options.moved or asked != rounded:
        made = tiler.tile(
            options.tiles or None,
            lattice=options.lattice,
            direction=options.direction,
            turn=options.turn or None,
            progress=scaled(progress, PLACING_SHARE, 1.0),
        )
        component.last_rounded.clear()
        component.last_rounded[tiler] = rounded, made
    return tiler.move_poles(made, dict(options.moved), progress=progress) if options.moved else made


def own_options(component, options, tiles):
    """The `TileOptions` of one part, vertices as it counts them: automatic poles where none of the chosen ones lies,
    and none where none may be; the poles that are dragged on it."""
    poles, allowed, own = options.poles, options.allowed, component.surface.vertex_index
    if isinstance(poles, tuple):
        poles = tuple(np.flatnonzero(np.isin(own, poles)).tolist()) or "auto"
    if allowed is not None:
        mask = np.frombuffer(allowed, bool)[own]
        allowed = mask.tobytes()
        if not mask.any():
            allowed, poles = None, poles if isinstance(poles, tuple) else 0
    moved = tuple((pole, int(place)) for pole, vertex in options.moved for place in np.flatnonzero(own == vertex))
    return replace(options, tiles=tiles, poles=poles, quarters=0, pole_group="", allowed=allowed, moved=moved)


def placed(solved, parts, quarters=0):
    """(#C, 2) float32: parts with a tiling side by side in the UV plane, each turned by quarters and moved by whole
    units; zeros elsewhere."""
    uv = np.zeros((len(solved.polygons.corner_vertices), 2))
    turn = np.linalg.matrix_power(QUARTER, quarters % 4)
    turned = [part.tiling.uv @ turn for part in parts]
    lows = [np.floor(values.min(axis=0)) for values in turned]
    sizes = np.array([np.ceil(values.max(axis=0)) - low for values, low in zip(turned, lows)])
    width = max(math.ceil(math.sqrt(np.prod(sizes, axis=1).sum())), sizes[:, 0].max())
    corners, _ = native.load().layout.rows(sizes, width, 0.0)
    for part, values, low, corner in zip(parts, turned, lows, corners):
        uv[part.component.surface.corner_index] = values + (corner - low)
    return on_grid(uv)


def on_grid(uv):
    """Rounded to a power of two that every value is a multiple of in float32 as well: differences by whole numbers stay
    exact."""
    largest = np.abs(uv).max()
    step = 2.0 ** (math.frexp(max(largest, 1.0))[1] - MANTISSA)
    return (np.floor(uv / step + 0.5) * step).astype(np.float32)
