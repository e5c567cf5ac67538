"""The maps of all parts of a mesh: `automatic_map` for each, all with squares of one size."""

from __future__ import annotations

import numbers
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.array_types import Progress
from ..core.arrays import integer
from ..mesh.checks import check_list, check_type
from ..mesh.given_vertices import on_part
from ..mesh.surface import Surface
from ..tiling.tiling import Poles
from .automatic_structure import AnyStructure
from .map import Map
from .map_choice import EVENNESS, Refusal
from .map_objects import Request, map_objects
from .size import TOLERANCE, SizePolicy


def automatic_maps(
    surfaces: Surface | Sequence[Surface],
    structures: Sequence[AnyStructure] | None = None,
    *,
    main: str | Sequence[str] = "automatic",
    tiles: float | None = None,
    density: float | None = None,
    density_tolerance: float = TOLERANCE,
    poles: Poles = "auto",
    allowed: ArrayLike | None = None,
    moves: Sequence[tuple[int, int]] = (),
    direction: ArrayLike | str | None = "upright",
    evenness: float = EVENNESS,
    threads: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> list[Map | Refusal]:
    """The `Map` of each part of a mesh, or the error that says why it cannot be made.

    The median densities of tilings differ by a tenth at most from that of the largest part, which is made first. A part
    on which whole tiles are too few for that, or have no room, gets another map, which `arrangement` scales. Small
    parts are made side by side, and copies of one part once. Vertices are those of the mesh as given.

    Parameters
    ----------
    surfaces : the connected parts, or a Surface whose components they are
    structures : of all parts, as in `automatic_map`
    main : of all parts, or of each
    tiles, density : tiles over all parts, in proportion to their areas, or per unit of area; default `usual_density`
    density_tolerance : relative amount by which the median density of the largest part, and so of all, may differ from
        the one given, where whole tiles cannot have it; 0 where other meshes have that density
    poles : "auto", a number for each part, or a list of vertices; "auto" on parts without any
    allowed : (#V,) bool, where poles may be that are not chosen; parts without such vertices get none
    moves : (index of a pole in the tiling of its part, vertex) for each pole that is moved after the rounding
    direction, evenness, options, threads, progress : as in `automatic_map`
    """
    parts = surfaces.components if isinstance(surfaces, Surface) else tuple(surfaces)
    for part in parts:
        check_type(part, Surface, "a part")
    if not isinstance(main, str):
        check_list(main, "main")
    check_list(moves, "moves")
    mains = [main] * len(parts) if isinstance(main, str) else main
    requests = [
        request_of_part(part, structure, wanted, poles, allowed, moves, evenness, direction, options)
        for part, structure, wanted in zip(parts, structures or [None] * len(parts), mains)
    ]
    ((made, _),) = map_objects([requests], SizePolicy.of(parts, tiles, density, density_tolerance), threads, progress)
    for found in made:
        if isinstance(found, MemoryError):
            raise found
    return made


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
