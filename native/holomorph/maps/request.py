"""What is asked for of one connected part."""

from __future__ import annotations

import numbers
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.array_types import Complexes, Reals
from ..core.arrays import integer
from ..mesh.given_vertices import on_part
from ..mesh.surface import Surface
from ..tiling.tiling import Poles
from .automatic_structure import AnyStructure

MAIN_MAPS = ("automatic", "seamless", "untiled", "balanced")
EVENNESS = 0.5  # what suits textures: squares hardly differ in size, and their shear is not seen


@dataclass(frozen=True, eq=False)
class Request:
    """What is asked for of one connected part, in the part's own vertices.

    structure : None to make it, by `automatic_structure`
    main : as in `automatic_map`
    coefficients : of a "balanced" map, None for those of the balanced one
    options : further ones of `Structure.tile`
    """

    surface: Surface
    structure: AnyStructure | None = None
    main: str = "automatic"
    poles: Poles = "auto"
    evenness: float = EVENNESS
    direction: Any = "upright"
    coefficients: Complexes | Reals | None = None
    options: Mapping[str, Any] = field(default_factory=dict)

    @property
    def tiling(self) -> dict[str, Any]:
        """All options of `Structure.tile` but poles."""
        return {"direction": self.direction, "evenness": self.evenness, **self.options}

    @property
    def key(self) -> tuple[Any, ...]:
        """Equal where the same is asked of two parts. A structure that is given may be of choices on that part."""
        given = id(self.structure) if self.main == "balanced" and self.structure is not None else None
        asked = self.main, self.poles, self.evenness, self.direction, self.coefficients, self.options
        return given, *_plain(asked)


def request_of_part(
    part: Surface,
    structure: AnyStructure | None,
    main: str,
    poles: Poles,
    allowed: ArrayLike | None,
    moves: Sequence[tuple[int, int]],
    evenness: float,
    direction: ArrayLike | str | None,
    options: dict[str, Any],
) -> Request:
    """The `Request` for a part of a mesh, from poles, places and moves in vertices of the mesh as given."""
    if not isinstance(poles, (str, numbers.Real)):
        places, is_there = on_part(part, integer(poles, "poles"))
        poles = places[is_there].tolist() or "auto"
    if allowed is not None:
        allowed = np.asarray(allowed, bool)
        if allowed.shape != (part.given_vertex_count,):
            raise ValueError(f"allowed has the shape {allowed.shape}; ({part.given_vertex_count},) is needed")
        allowed = allowed[part.vertex_index]
        if not allowed.any():
            allowed, poles = None, 0 if isinstance(poles, (str, numbers.Real)) else poles
    places, is_there = on_part(part, integer([vertex for _, vertex in moves], "moves"))
    own = {pole: int(place) for (pole, _), place, has in zip(moves, places, is_there) if has}
    return Request(
        part, structure, main, poles, evenness, direction, options=options | {"allowed": allowed, "moves": own}
    )


def _plain(value):
    """Can be compared and hashed, where arrays cannot."""
    if isinstance(value, np.ndarray):
        return value.shape, value.dtype.str, value.tobytes()
    value = sorted(value.items()) if isinstance(value, Mapping) else value
    return tuple(map(_plain, value)) if isinstance(value, (tuple, list)) else value
