"""What is asked of a tiling, for the core."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..core import arrays
from ..core.value import quoted
from ..mesh.checks import checked_evenness, only_component, real_number
from ..mesh.origin import edges_on_part
from ..mesh.surface import Surface
from .tilings import BOUNDARIES, UPRIGHT, Poles, asked_poles, generators, heading, own_allowed, own_poles
from .turned import NO_EDGES, missing_turns


def tile_options(
    surface: Surface,
    poles: Poles = "auto",
    tiles: float | None = None,
    *,
    evenness: float = 0.0,
    lattice: str | ArrayLike = "square",
    direction: ArrayLike | str | None = UPRIGHT,
    turn: float | None = None,
    max_turn: float = 0.2,
    boundary: str = "automatic",
    max_added: float | None = None,
    allowed: ArrayLike | None = None,
    moves: Mapping[int, int] | None = None,
    turns: int = 1,
    lines: str = "none",
    marked: ArrayLike | None = None,
    cones: Mapping[int, float] | None = None,
) -> _native.TileOptions:
    """The options of `Structure.tile`. Raises ValueError and TopologyError for what does not fit."""
    component = only_component(surface)
    count, chosen = asked_poles(poles)
    if boundary not in BOUNDARIES:
        raise ValueError(f"boundary is {quoted(boundary)}; one of {', '.join(BOUNDARIES)} is needed")
    if max_added is not None and real_number(max_added, "max_added") < 1:
        raise ValueError(f"max_added is {quoted(max_added)}; an angle distortion of at least 1 is needed")
    moves = {} if moves is None else moves
    if not isinstance(moves, Mapping):
        raise ValueError(f"moves is {quoted(moves)}; a dictionary from poles to vertices is needed")
    missing = None
    if cones is not None:  # of a tiling that does not turn only whether some are chosen counts
        missing = missing_turns(surface, component, cones, turns).tolist() if turns != 1 else []
    is_upright, vector = heading(direction)
    return _native.TileOptions(
        tiles=0.0 if tiles is None else real_number(tiles, "tiles", positive=True),
        evenness=checked_evenness(evenness),
        count=count,
        poles=own_poles(surface, component, chosen),
        allowed=own_allowed(allowed, surface, component),
        lattice=generators(lattice),
        is_upright=is_upright,
        direction=vector,
        turn=None if turn is None else real_number(turn, "turn"),
        max_turn=real_number(max_turn, "max_turn"),
        boundary=boundary,
        max_added=max_added,
        moves=list(zip(moves, own_poles(surface, component, list(moves.values())))),
        turns=turns,
        lines=lines,
        marked=_own_edges(surface, component, marked),
        missing=missing,
    )


def part_of(surface, component=None):
    """The core's value of the one component of a surface, whose vertices messages name."""
    component = surface.components[0] if component is None else component
    if component is surface:
        return surface._part
    return _native.WholePart(component._native, component.up, component.vertex_index.tolist())


def _own_edges(surface, component, ends):
    if ends is None:
        return NO_EDGES
    ends = arrays.integer(ends, "marked", 2, (2,))
    return ends if component is surface else np.asarray(edges_on_part(component, ends), np.int32)
