# SPDX-License-Identifier: GPL-3.0-or-later
"""Seamless tilings out of a solve, and their place in the UV plane. No bpy here: it runs in a worker thread.

UVs are moved by whole units, turned by quarters, and rounded to a grid that float32 holds exactly: so the sides of a
cut differ by whole units to the last bit.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from . import jobs, layout, native

AUTOMATIC = "auto"
MANTISSA = 24  # bits of a float32
QUARTER = np.array([[0, 1], [-1, 0]])  # rows times it: a quarter turn counter-clockwise


@dataclass(frozen=True)
class TileOptions:
    """What is asked of `holomorph.Structure.tile` for one object."""

    tiles: float = 0.0  # of the texture over the whole object; 0 lets the library choose
    poles: object = AUTOMATIC  # or a number for each part, or a tuple of vertices of the object
    lattice: str = "square"
    direction: tuple | None = None  # in the frame of the solved polygons
    boundary: str = "straight"


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

    @property
    def done(self):
        """The parts that have a tiling."""
        return [part for part in self.parts if part.tiling is not None]


class TileWork(jobs.Work):
    """Solves and tiles one object after the other; `results` as in `jobs.Job`."""

    SOLVE_SHARE = 0.3  # of the work on an object

    def __init__(self, tasks, options, progress=None):
        super().__init__(progress)
        self.results = [None] * len(tasks)
        self._tasks, self._options = tasks, options

    def run(self):
        refusals = native.refusals()
        for index, (task, options) in enumerate(zip(self._tasks, self._options)):
            if self._cancelled.is_set():
                return
            try:
                found = jobs.solved(task, self._part_of(index, 0, self.SOLVE_SHARE))
                self.results[index] = tile(found, options, self._part_of(index, self.SOLVE_SHARE, 1))
            except refusals as error:
                self.results[index] = error

    def _part_of(self, index, begin, end):
        """The progress function of one stage of one object."""
        count = len(self._tasks)
        return lambda fraction, stage: self.ask((index + begin + (end - begin) * fraction) / count, stage)


def tile(solved, options, progress=None):
    """The `TiledObject` of a solve; a part that the library refuses keeps its sentence."""
    total = sum(c.area for c in solved.done)
    parts, done = [], 0.0
    for component in solved.components:
        if component.structure is None:
            parts.append(TiledPart(component, None, str(component.reason)))
            continue
        share = component.area / total if total > 0 else 1.0
        parts.append(_tile_part(component, options, share, _scaled(progress, done, share)))
        done += share
    return TiledObject(solved, tuple(parts))


def _tile_part(component, options, share, progress):
    holomorph = native.load()
    own = replace(options, tiles=options.tiles * share, poles=_own_poles(component, options.poles))
    if own not in component.tilings:
        try:
            made = component.tiler.tile(
                tiles=own.tiles or None,
                poles=own.poles if isinstance(own.poles, (str, int)) else list(own.poles),
                lattice=own.lattice,
                direction=own.direction,
                boundary=own.boundary,
                progress=progress,
            )
        except (holomorph.InvalidMesh, holomorph.TopologyError, holomorph.SolverError) as error:
            return TiledPart(component, None, str(error))
        component.keep_tiling(own, made)
    return TiledPart(component, component.tilings[own])


def _own_poles(component, poles):
    """The chosen vertices as the part counts them; automatic poles on a part without any."""
    if not isinstance(poles, tuple):
        return poles
    own = np.flatnonzero(np.isin(component.surface.vertex_index, poles))
    return tuple(own.tolist()) or AUTOMATIC


def _scaled(progress, done, share):
    if progress is None:
        return None
    return lambda fraction, stage: progress(done + share * fraction, stage)


def placed(tiled, quarters=0):
    """(#C, 2) float32: the parts side by side in the UV plane, each turned by quarters and moved by whole units."""
    uv = np.zeros((len(tiled.solved.surface.corner_vertices), 2))
    turn = np.linalg.matrix_power(QUARTER, quarters % 4)
    turned = [part.tiling.uv @ turn for part in tiled.done]
    lows = [np.floor(values.min(axis=0)) for values in turned]
    sizes = np.array([np.ceil(values.max(axis=0)) - low for values, low in zip(turned, lows)])
    width = max(math.ceil(math.sqrt(np.prod(sizes, axis=1).sum())), sizes[:, 0].max())
    corners, _ = layout.rows(sizes, width, 0.0)
    for part, values, low, corner in zip(tiled.done, turned, lows, corners):
        uv[part.component.surface.corner_index] = values + (corner - low)
    return on_grid(uv)


def on_grid(uv):
    """Rounded to a power of two that every value is a multiple of in float32 as well: differences by whole numbers stay
    exact."""
    largest = np.abs(uv).max()
    step = 2.0 ** (math.frexp(max(largest, 1.0))[1] - MANTISSA)
    return (np.round(uv / step) * step).astype(np.float32)
