"""The maps of all parts of a mesh: `automatic_map` for each, their tilings at one density."""

import numbers
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._native import InvalidMesh, SolverError, TopologyError
from .array_types import Progress
from .arrays import integer
from .automatic_map import EVENNESS, REFUSALS, SOLVING, Undecided, first_map
from .automatic_structure import AnyStructure
from .given_vertices import on_part
from .map import Map
from .progress import scaled
from .surface import Surface
from .tiling import Poles

Refusal = InvalidMesh | TopologyError | SolverError  # what is said about one part, others go on


def automatic_maps(
    surfaces: Surface | Sequence[Surface],
    structures: Sequence[AnyStructure] | None = None,
    *,
    main: str | Sequence[str] = "automatic",
    tiles: float | None = None,
    density: float | None = None,
    equal_density: bool = True,
    poles: Poles = "auto",
    allowed: ArrayLike | None = None,
    moves: Sequence[tuple[int, int]] = (),
    direction: ArrayLike | str | None = "upright",
    evenness: float = EVENNESS,
    threads: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> list[Map | Refusal]:
    """The `Map` of each part of a mesh, and the error that says why in the place of one that cannot be made.

    Vertices are those of the mesh as given.

    Parameters
    ----------
    surfaces : the connected parts, or a Surface whose components they are
    structures : of all parts, as in `automatic_map`
    main : of all parts, or of each
    tiles, density : tiles over all the parts that get tilings, in proportion to their areas, or per unit of area
    equal_density : whether without these all tilings have the density of the largest, which is made first; else each
        part gets the number that suits it
    poles : "auto", a number for each part, or a list of vertices; "auto" on parts without any
    allowed : (#V,) bool, where poles may be that are not chosen; parts without such vertices get none
    moves : (index of a pole in the tiling of its part, vertex) for each pole that is moved after the rounding
    direction, evenness, options, threads, progress : as in `automatic_map`
    """
    if tiles is not None and density is not None:
        raise ValueError("a density is given without tiles: either says how many there are")
    parts = surfaces.components if isinstance(surfaces, Surface) else tuple(surfaces)
    done = SOLVING if structures is None else 0.0
    made = _first_maps(parts, structures, main, evenness, threads, scaled(progress, 0.0, done))
    undecided = {k: found for k, found in enumerate(made) if isinstance(found, Undecided)}
    total, rest = sum(parts[k].area for k in undecided) or 1.0, 1 - done
    for k in sorted(undecided, key=lambda k: -parts[k].area):
        share = parts[k].area / total
        step = scaled(progress, done, done + rest * share)
        own_poles, own = _own_choices(parts[k], poles, allowed, moves)
        own |= {"direction": direction, "evenness": evenness} | options | _amount(tiles, density, share)
        made[k] = _attempt(undecided[k].tiled, own_poles, own, step)
        if equal_density and density is None:
            density = _tiled_density(made[k])
        done += rest * share
    return made


def _amount(tiles, density, share):
    """The options of `Structure.tile` that say how many tiles a share of the area gets."""
    return {"tiles": tiles * share or None} if tiles else {"density": density}


def _tiled_density(found):
    """That of a `Map` with a tiling; None for others, and for an error."""
    return found.density if isinstance(found, Map) and found.tiling else None


def _first_maps(parts, structures, main, evenness, threads, progress):
    """What `first_map` gives for each part, or how that refuses."""
    count = len(parts)
    mains = [main] * count if isinstance(main, str) else main
    steps = [scaled(progress, k / count, (k + 1) / count) for k in range(count)]
    return [
        _attempt(first_map, part, structure, own, evenness, threads, step)
        for part, structure, own, step in zip(parts, structures or [None] * count, mains, steps)
    ]


def _attempt(make, *arguments):
    """What it gives, or how it refuses."""
    try:
        return make(*arguments)
    except REFUSALS as error:
        return error


def _own_choices(part, poles, allowed, moves):
    """(poles, other options of `Structure.tile`) of a part, vertices as it counts them."""
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
    places, is_there = on_part(part, [vertex for _, vertex in moves])
    own = {pole: int(place) for (pole, _), place, has in zip(moves, places, is_there) if has}
    return poles, {"allowed": allowed, "moves": own}
