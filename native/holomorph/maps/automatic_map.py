"""The map of one connected part, by the same steps as those of all parts of a mesh."""

from __future__ import annotations

from numpy.typing import ArrayLike

from ..core.array_types import Progress
from ..mesh.checks import check_type
from ..mesh.surface import Surface
from ..tiling.tiling import Poles
from .automatic_structure import AnyStructure
from .map import Map
from .map_objects import map_objects
from .request import EVENNESS, Request
from .size import TOLERANCE, SizePolicy


def automatic_map(
    surface: Surface,
    structure: AnyStructure | None = None,
    *,
    main: str = "automatic",
    tiles: float | None = None,
    density: float | None = None,
    density_tolerance: float = TOLERANCE,
    poles: Poles = "auto",
    lattice: str | ArrayLike = "square",
    direction: ArrayLike | str | None = "upright",
    boundary: str = "automatic",
    turn: float | None = None,
    max_turn: float = 0.2,
    max_added: float | None = None,
    turns: int = 1,
    evenness: float = EVENNESS,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Map:
    """The `Map` of one connected part of any kind.

    It is the one of lowest visual cost (`appearance.cost`) among flat islands (`island_map`), tilings, the balanced map
    and maps in pieces, some of them tilings. A part that is flat, or falls into flat pieces at its hard edges, gets
    these at once. What cannot cost less than what was found is not tried.

    Parameters
    ----------
    surface : Surface, connected; isolated vertices are ignored
    structure : its conformal structure, default `automatic_structure`. It keeps the poles that were placed: another
        call with other tiles, lattice or direction is quick
    main : "automatic"; "seamless" for a tiling in any case; "untiled" for the best of the other maps; "balanced" for a
        map of forms, as when something about the structure was chosen
    tiles, poles, lattice, boundary, turn, max_turn, max_added, turns : of tilings, as in `Structure.tile`
    density, density_tolerance : tiles per unit of area, and the relative amount by which whole tiles may miss it; where
        they miss it by more, the map is not a tiling
    direction : "upright" for rows that run level, ignored on intrinsic surfaces; a vector along which u runs; or None
    evenness : from 0 for a conformal map to 1 for squares of nearly one size; see `Structure.tile`
    threads : as in `conformal_structure`
    progress : progress(fraction, stage), called at most every 20 ms; returning False cancels

    Raises what `automatic_structure` raises; TopologyError or SolverError if a tiling was asked for and cannot be made,
    or would lose more than 2 % of the area, as on a mesh of few faces.
    Source: ours, docs/choice.md; what an eye minds was judged on pictures (`appearance`).

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> found = holomorph.automatic_map(surface)
    >>> print(found.kind, found.verdict.sentence)
    tiling Even, seamless, no poles
    """
    check_type(surface, Surface)
    options = {"lattice": lattice, "boundary": boundary, "turn": turn, "max_turn": max_turn, "max_added": max_added}
    options |= {"turns": turns}
    request = Request(surface, structure, main, poles, evenness, direction, options=options)
    size = SizePolicy.of([surface], tiles, density, density_tolerance)
    (((made,), _),) = map_objects([[request]], size, threads, progress)
    if isinstance(made, Map):
        return made
    raise made
