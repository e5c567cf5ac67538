"""What is asked for of one connected part."""

from __future__ import annotations

import numbers
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.array_types import Complexes, Reals
from ..core.arrays import integer
from ..mesh.origin import on_part
from ..mesh.surface import Surface
from ..tiling.tiling import Poles
from .automatic_structure import AnyStructure
from .chosen_structures import PartStructure

MAIN_MAPS = ("automatic", "seamless", "untiled", "balanced")
EVENNESS = 0.5  # what suits textures: squares hardly differ in size, and their shear is not seen
MIXED_EVENED = 20_000  # triangles up to which maps are evened while forms are mixed: it takes 0.2 s


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


def requests_of_parts(
    parts: Sequence[PartStructure],
    main: str,
    poles: Poles,
    allowed: ArrayLike | None,
    moves: Sequence[tuple[int, int]],
    evenness: float,
    direction: ArrayLike | str | None,
    options: dict[str, Any],
    amounts: Sequence[float] = (),
    phases: Sequence[float] = (),
) -> list[Request]:
    """The `Request`s for parts of a mesh; "automatic" is "balanced" on those where a structure was chosen, or without
    area.

    amounts, phases : factor and phase (radians) of the share of each form in balanced maps; where some change them,
        maps of more than `MIXED_EVENED` triangles are not evened
    """
    is_mixed = any(amount != 1 for amount in amounts) or any(phase != 0 for phase in phases)
    made = []
    for part in parts:
        is_open = main == "automatic" and not part.is_chosen and part.surface.area > 0
        own = main if is_open or main != "automatic" else "balanced"
        is_slow = own == "balanced" and is_mixed and len(part.surface.triangles) > MIXED_EVENED
        given, evened = (part.surface, part.structure, own, poles, allowed, moves), 0.0 if is_slow else evenness
        made.append(request_of_part(*given, evened, direction, options))
        if own == "balanced":
            made[-1] = replace(made[-1], coefficients=_mixed_coefficients(part.structure, amounts, phases))
    return made


def _mixed_coefficients(structure, amounts, phases):
    """The balanced coefficients with these factors and phases. Real where the balanced ones are: a complex factor would
    bend the straight boundaries."""
    result = np.array(structure.balanced_coefficients())
    factors = np.array(amounts, float)
    if np.iscomplexobj(result):
        factors = factors * np.exp(1j * np.array(phases, float))
    shared = min(len(result), len(factors))
    result[:shared] *= factors[:shared]
    return result


def _plain(value):
    """Can be compared and hashed, where arrays cannot."""
    if isinstance(value, np.ndarray):
        return value.shape, value.dtype.str, value.tobytes()
    value = sorted(value.items()) if isinstance(value, Mapping) else value
    return tuple(map(_plain, value)) if isinstance(value, (tuple, list)) else value
