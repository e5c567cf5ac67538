"""The maps of all parts of a mesh: `automatic_map` for each, all with squares of one size."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from numpy.typing import ArrayLike

from ..core.array_types import Progress
from ..mesh.checks import check_list, check_type
from ..mesh.surface import Surface
from ..tiling.tiling import Poles
from .automatic_structure import AnyStructure
from .map import Map
from .map_objects import map_objects
from .request import EVENNESS, MeshRequest
from .size import SizePolicy
from .tiling_search import Refusal


def automatic_maps(
    surfaces: Surface | Sequence[Surface],
    structures: Sequence[AnyStructure] | None = None,
    *,
    main: str | Sequence[str] = "automatic",
    tiles: float | None = None,
    density: float | None = None,
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
    tiles, density : tiles over all parts, in proportion to their areas, or per unit of area, which the
        median of the largest part, and so of all, misses by 20 % at most, where whole tiles cannot have it; default
        `usual_density`
    poles : "auto", a number for each part, or a list of vertices; "auto" on parts without any
    allowed : (#V,) bool, where poles may be that are not chosen; parts without such vertices get none
    moves : (index of a pole in the tiling of its part, vertex) for each pole that is moved after the rounding
    direction, evenness, options, threads, progress : as in `automatic_map`

    Raises ValueError and TypeError for arguments that do not fit; MemoryError; Cancelled. What a part itself raises
    takes the place of its map.
    Source: as `automatic_map`.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> (found,) = holomorph.automatic_maps(surface, tiles=64)
    >>> print(found.kind, found.evenness)
    tiling 0.5
    """
    parts = surfaces.components if isinstance(surfaces, Surface) else tuple(surfaces)
    for part in parts:
        check_type(part, Surface, "a part")
    if not isinstance(main, str):
        check_list(main, "main")
    check_list(moves, "moves")
    mains = [main] * len(parts) if isinstance(main, str) else main
    asked = MeshRequest(
        poles=poles, allowed=allowed, moves=moves, direction=direction, evenness=evenness, options=options
    )
    requests = [asked.of_part(*each) for each in zip(parts, structures or [None] * len(parts), mains)]
    ((made, _),) = map_objects([requests], SizePolicy.of(parts, tiles, density), threads, progress)
    for found in made:
        if isinstance(found, MemoryError):
            raise found
    return made
