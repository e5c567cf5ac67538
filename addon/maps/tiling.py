# SPDX-License-Identifier: GPL-3.0-or-later
"""Seamless tilings out of a solve, and their place in the UV plane. No bpy here: it runs in a worker thread.

UVs are moved by whole units, turned by quarters, and rounded to a grid that float32 holds exactly: so the sides of a
cut differ by whole units to the last bit.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from .. import native

AUTOMATIC = "auto"
PLACING_SHARE = 0.6  # of the work on a tiling, for finding the poles
MANTISSA = 24  # bits of a float32
UPRIGHT = {"direction": (0.0, 0.0, 1.0), "turn": math.pi / 2}  # u runs along Z, turned by a right angle: v does
QUARTER = np.array([[0, 1], [-1, 0]])  # rows times it: a quarter turn counter-clockwise


@dataclass(frozen=True)
class TileOptions:
    """What is asked of `holomorph.Structure.tile` for one object."""

    tiles: float = 0.0  # of the texture over the whole object; 0 lets the library choose
    poles: object = AUTOMATIC  # or a number for each part, or a tuple of vertices of the object
    lattice: str = "square"
    direction: tuple | None = None  # in the frame of the solved polygons
    boundary: str = "straight"
    turn: float = 0.0  # radians by which the texture is rotated
    allowed: bytes | None = None  # of the bools that tell where poles may be that are not chosen; None for anywhere
    moved: tuple = ()  # (index of a pole in its part's tiling, vertex to which it was dragged)


@dataclass(frozen=True)
class TiledPart:
    """One part: `tiling` is what the library made, its vertices as the part counts them; None where it says why not."""

    component: object  # `solve.SolvedComponent`
    tiling: object | None
    reason: str = ""

    def vertices(self, own):
        """Vertices of the whole object."""
        return self.component.surface.vertex_index[np.asarray(own, np.int64)]


@dataclass(frozen=True)
class TiledObject:
    """The parts of one object in the library's order."""

    solved: object  # `solve.SolvedObject`
    parts: tuple
    options: TileOptions = TileOptions()  # that all parts share

    @property
    def done(self):
        """The parts that have a tiling."""
        return [part for part in self.parts if part.tiling is not None]

    @property
    def density(self):
        """Tiles for an area on the surface, where there is the median of them; 0 without a tiling."""
        area = sum(part.component.area for part in self.done)
        return sum(part.tiling.tiles for part in self.done) / area if area > 0 else 0.0

    @property
    def unit_length(self):
        """The length on the surface of a UV unit, where the density is the median one; 0 for maps without area."""
        density = np.median([part.tiling.quality.median_density for part in self.done])
        return 1 / math.sqrt(density) if density > 0 else 0.0


def tile(solved, options, progress=None):
    """The `TiledObject` of a solve; a part that the library refuses keeps its sentence."""
    total = sum(c.area for c in solved.done)
    parts, done = [], 0.0
    for component in solved.components:
        if component.structure is None:
            parts.append(TiledPart(component, None, str(component.reason)))
            continue
        share = component.area / total if total > 0 else 1.0
        own = _own_options(component, options, share)
        parts.append(tile_part(component, own, scaled(progress, done, share)))
        done += share
    return TiledObject(solved, tuple(parts), options)


class Evenly:
    """Makes the `TiledObject` of one solve after the other, all with as many tiles for their area as the first one."""

    def __init__(self):
        self._density = 0.0

    def __call__(self, solved, options, progress=None):
        area = sum(c.area for c in solved.done)
        if self._density and area > 0:
            options = replace(options, tiles=self._density * area)
        made = tile(solved, options, progress)
        self._density = self._density or made.density
        return made


def tile_part(component, options, progress=None):
    """The `TiledPart` of a part; what it gave before is kept, a refusal too."""
    if options not in component.tilings:
        holomorph = native.load()
        try:
            made, reason = _made(component, options, progress), ""
        except (holomorph.InvalidMesh, holomorph.TopologyError, holomorph.SolverError) as error:
            made, reason = None, str(error)
        component.keep_tiling(options, TiledPart(component, made, reason))
    return component.tilings[options]


def _made(component, options, progress):
    """The library's `Tiling`; what it rounded last is not rounded again for poles that are dragged."""
    tiler = component.tiler(options.poles, options.boundary, options.allowed, scaled(progress, 0.0, PLACING_SHARE))
    rounded = replace(options, moved=())
    if not options.moved or component.last_rounded.get(tiler) != rounded:
        made = tiler.tile(
            options.tiles or None,
            lattice=options.lattice,
            direction=options.direction,
            turn=options.turn or None,
            progress=scaled(progress, PLACING_SHARE, 1 - PLACING_SHARE),
        )
        component.last_rounded.clear()
        component.last_rounded[tiler] = rounded
    return tiler.with_poles_moved(dict(options.moved), progress=progress) if options.moved else made


def _own_options(component, options, share):
    """What is asked of one part, vertices as it counts them: its share of the tiles; automatic poles where none of the
    chosen ones lies, and none where none may be; the poles that are dragged on it."""
    poles, allowed, own = options.poles, options.allowed, component.surface.vertex_index
    if isinstance(poles, tuple):
        poles = tuple(np.flatnonzero(np.isin(own, poles)).tolist()) or AUTOMATIC
    if allowed is not None:
        mask = np.frombuffer(allowed, bool)[own]
        allowed = mask.tobytes()
        if not mask.any():
            allowed, poles = None, poles if isinstance(poles, tuple) else 0
    moved = tuple((pole, int(place)) for pole, vertex in options.moved for place in np.flatnonzero(own == vertex))
    return replace(options, tiles=options.tiles * share, poles=poles, allowed=allowed, moved=moved)


def scaled(progress, done, share):
    """The progress function of a share of the work."""
    if progress is None:
        return None
    return lambda fraction, stage: progress(done + share * fraction, stage)


def placed(tiled, quarters=0):
    """(#C, 2) float32: the parts side by side in the UV plane, each turned by quarters and moved by whole units."""
    uv = np.zeros((len(tiled.solved.polygons.corner_vertices), 2))
    turn = np.linalg.matrix_power(QUARTER, quarters % 4)
    turned = [part.tiling.uv @ turn for part in tiled.done]
    lows = [np.floor(values.min(axis=0)) for values in turned]
    sizes = np.array([np.ceil(values.max(axis=0)) - low for values, low in zip(turned, lows)])
    width = max(math.ceil(math.sqrt(np.prod(sizes, axis=1).sum())), sizes[:, 0].max())
    corners, _ = native.load().layout.rows(sizes, width, 0.0)
    for part, values, low, corner in zip(tiled.done, turned, lows, corners):
        uv[part.component.surface.corner_index] = values + (corner - low)
    return on_grid(uv)


def on_grid(uv):
    """Rounded to a power of two that every value is a multiple of in float32 as well: differences by whole numbers stay
    exact."""
    largest = np.abs(uv).max()
    step = 2.0 ** (math.frexp(max(largest, 1.0))[1] - MANTISSA)
    return (np.floor(uv / step + 0.5) * step).astype(np.float32)
