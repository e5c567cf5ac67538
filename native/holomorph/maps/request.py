"""What is asked for of one connected part."""

from __future__ import annotations

import numbers
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..core.arrays import integer
from ..core.value import quoted
from ..mesh.checks import checked_evenness
from ..mesh.origin import edges_on_part, on_part
from ..mesh.surface import Surface
from ..tiling.options import part_of, tile_options
from ..tiling.tilings import Poles
from ..tiling.turned import AUTOMATIC, NO_EDGES
from .automatic_structure import AnyStructure
from .chosen_structures import PartStructure
from .late_structure import LateStructure

MAIN_MAPS = ("automatic", "seamless", "untiled", "balanced")
EVENNESS = 0.5  # what suits textures: squares hardly differ in size, and their shear is not seen


@dataclass(frozen=True, eq=False)
class Request:
    """What is asked for of one connected part, in the part's own vertices.

    structure : None to make it, by `automatic_structure`
    main : as in `automatic_map`
    options : further ones of `Structure.tile`
    effort : as in `automatic_map`
    """

    surface: Surface
    structure: AnyStructure | None = None
    main: str = "automatic"
    poles: Poles = "auto"
    evenness: float = EVENNESS
    direction: Any = "upright"
    options: Mapping[str, Any] = field(default_factory=dict)
    effort: float = 1.0

    @property
    def is_upright(self) -> bool:
        """Whether v is to run up."""
        return isinstance(self.direction, str)

    @property
    def key(self) -> tuple[Any, ...]:
        """Equal where the same is asked of two parts. A structure that is given may be of choices on that part."""
        given = id(self.structure) if self.main == "balanced" and self.structure is not None else None
        asked = self.main, self.poles, self.evenness, self.direction, self.options, self.effort
        return given, *_plain(asked)

    def of_core(self) -> _native.Request:
        """The core's own value. Raises ValueError for an option that no tiling has."""
        if self.main not in MAIN_MAPS:
            raise ValueError(f"main is {quoted(self.main)}; one of {', '.join(MAIN_MAPS)} is needed")
        structure = self._solved
        return _native.Request(
            structure._part if structure else part_of(self.surface),
            structure._core if structure else None,
            main=self.main,
            evenness=checked_evenness(self.evenness),
            tiling=tile_options(self.surface, self.poles, direction=self.direction, **self.options),
            lines=self.options.get("lines", AUTOMATIC),
            seams=NO_EDGES,
            hard_edges=0.0,
            most_stretch=0.0,
            effort=self.effort,
        )

    @property
    def _solved(self):
        """The structure, if it is solved for or has to be; else None: other maps than of forms may do."""
        is_late = isinstance(self.structure, LateStructure)
        if is_late and (self.main in ("seamless", "balanced") or not isinstance(self.poles, str)):
            return self.structure.made
        return None if is_late else self.structure


@dataclass(frozen=True, eq=False)
class MeshRequest:
    """What is asked for of all parts of a mesh, in vertices of the mesh as given; see `automatic_maps`.

    options : further ones of `Structure.tile`
    effort : as in `automatic_map`
    """

    main: str = "automatic"
    poles: Poles = "auto"
    allowed: ArrayLike | None = None
    moves: Sequence[tuple[int, int]] = ()
    marked: ArrayLike | None = None
    cones: Mapping[int, float] | None = None
    direction: ArrayLike | str | None = "upright"
    evenness: float = EVENNESS
    options: Mapping[str, Any] = field(default_factory=dict)
    effort: float = 1.0

    def of_part(self, part: Surface, structure: AnyStructure | None = None, main: str | None = None) -> Request:
        """The `Request` for a part. main : another than that of all parts"""
        poles, allowed = self.poles, self._allowed_on(part)
        if not isinstance(poles, (str, numbers.Real)):
            places, is_there = on_part(part, integer(poles, "poles"))
            poles = places[is_there].tolist() or "auto"
        if allowed is not None and not allowed.any():
            allowed, poles = None, 0 if isinstance(poles, (str, numbers.Real)) else poles
        places, is_there = on_part(part, integer([vertex for _, vertex in self.moves], "moves"))
        moves = {pole: int(place) for (pole, _), place, has in zip(self.moves, places, is_there) if has}
        marked = None if self.marked is None else edges_on_part(part, integer(self.marked, "marked", 2, (2,)))
        options = {**self.options, "allowed": allowed, "moves": moves, "marked": marked}
        options["cones"] = self._cones_on(part)
        chosen = {"options": options, "effort": self.effort}
        return Request(part, structure, main or self.main, poles, self.evenness, self.direction, **chosen)

    def of_structure(self, part: PartStructure) -> Request:
        """The `Request` for a part; "automatic" is "balanced" where its structure was chosen, or without area."""
        is_balanced = self.main == "automatic" and (part.is_chosen or not part.surface.area > 0)
        return self.of_part(part.surface, part.structure, "balanced" if is_balanced else None)

    def _cones_on(self, part):
        """{vertex of the part: angle}; None where none of them is chosen, and they are searched for."""
        if not self.cones:
            return None
        places, is_there = on_part(part, integer(list(self.cones), "cones"))
        return {int(v): angle for v, angle, has in zip(places, self.cones.values(), is_there) if has} or None

    def _allowed_on(self, part):
        if self.allowed is None:
            return None
        allowed = np.asarray(self.allowed, bool)
        if allowed.shape != (part.given_vertex_count,):
            raise ValueError(f"allowed has the shape {allowed.shape}; ({part.given_vertex_count},) is needed")
        return allowed[part.vertex_index]


def _plain(value):
    """Can be compared and hashed, where arrays cannot."""
    if isinstance(value, np.ndarray):
        return value.shape, value.dtype.str, value.tobytes()
    value = sorted(value.items()) if isinstance(value, Mapping) else value
    return tuple(map(_plain, value)) if isinstance(value, (tuple, list)) else value
