"""The map of one connected part, the best or of a kind that is asked for; and those of all parts of a mesh, by the same
steps, with squares of one size."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from numpy.typing import ArrayLike

from .. import _native
from .._native import TopologyError
from ..core.array_types import Progress
from ..core.progress import scaled
from ..mesh.checks import check_list, check_threads, check_type, checked_evenness, only_component
from ..mesh.surface import Surface
from ..tiling.request import AUTOMATIC, EVENNESS, Poles, Request, asked_turns, part_of
from .automatic_structure import AnyStructure, LateStructure
from .map import Map, Refusal, map_objects


def automatic_map(
    surface: Surface,
    structure: AnyStructure | None = None,
    *,
    main: str = "automatic",
    tiles: float | None = None,
    density: float | None = None,
    poles: Poles = "auto",
    lattice: str | ArrayLike = "square",
    direction: ArrayLike | str | None = "upright",
    boundary: str = "automatic",
    turn: float | None = None,
    max_turn: float = 0.2,
    max_added: float | None = None,
    turns: int | str = 1,
    texture: ArrayLike | None = None,
    lines: str = AUTOMATIC,
    marked: ArrayLike | None = None,
    cones: Mapping[int, float] | None = None,
    evenness: float = EVENNESS,
    effort: float = 1.0,
    seams: ArrayLike | None = None,
    hard_edges: float = 0.0,
    most_stretch: float = 0.0,
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
        map of forms, as when something about the structure was chosen; "islands" for flat pieces between chosen cuts
    tiles, poles, lattice, boundary, turn, max_turn, max_added, turns, texture : of tilings, as in `Structure.tile`
    lines, marked : likewise, where they can be made; "automatic" for lines that cost little, of "seamless" maps alone
    cones : likewise; then there are no lines
    density : tiles per unit of area; where whole tiles miss it by more than 20 %, the map is not a tiling
    direction : "upright" for rows that run level, ignored on intrinsic surfaces; a vector along which u runs; or None
    evenness : from 0 for a conformal map to 1 for squares of nearly one size; see `Structure.tile`
    seams, hard_edges, most_stretch : where "islands" are cut: along edges, (n, 2) vertices; along those that break off
        by more degrees, 0 for none; and open to cone points where lengths change by a larger factor, 0 for nowhere.
        They are cut on until they can be flattened, and where they lie over themselves
    effort : how much work may be spent on better maps, over the usual amount: some 5 s of one processor at 20,000
        triangles. The first map is made in any case, and `Map.why` says where others were not tried; 100 tries
        nearly all. Counted, not timed
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
    tiling Fairly even, seamless, a fifth is upside down, no poles
    """
    check_type(surface, Surface)
    chosen = {"main": main, "poles": poles, "marked": marked, "cones": cones, "evenness": evenness, "effort": effort}
    chosen |= {"lattice": lattice, "boundary": boundary, "direction": direction, "turn": turn, "max_turn": max_turn}
    chosen |= {"max_added": max_added, "turns": asked_turns(turns, texture), "lines": lines}
    chosen |= {"seams": seams, "hard_edges": hard_edges, "most_stretch": most_stretch}
    request = Request(tiles=tiles or None, density=density, **chosen)
    (((made,), _),) = map_objects([[(request, surface, structure)]], request.size_of([surface]), threads, progress)
    if isinstance(made, Map):
        return made
    raise made


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
    turns: int | str = 1,
    texture: ArrayLike | None = None,
    lines: str = AUTOMATIC,
    marked: ArrayLike | None = None,
    cones: Mapping[int, float] | None = None,
    evenness: float = EVENNESS,
    effort: float = 1.0,
    threads: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> list[Map | Refusal]:
    """The `Map` of each part of a mesh, or the error that says why it cannot be made.

    The median densities of tilings differ by a tenth at most from that of the largest part, which is made first, or by
    up to a fifth where other maps cost more. A part on which whole tiles are too few for that, or have no room, gets
    another map, which `arrangement` scales. Small parts are made side by side, and copies of one part once. Vertices
    are those of the mesh as given.

    Parameters
    ----------
    surfaces : the connected parts, or a Surface whose components they are
    structures : of all parts, as in `automatic_map`
    main : of all parts, or of each
    tiles, density : tiles over all parts, in proportion to their areas, or per unit of area, which the
        median of the largest part, and so of all, misses by 20 % at most, where whole tiles cannot have it; default
        100 tiles, or 64 for each handle, over the largest part
    poles : "auto", a number for each part, or a list of vertices; "auto" on parts without any
    allowed : (#V,) bool, where poles may be that are not chosen; parts without such vertices get none
    moves : (index of a pole in the tiling of its part, vertex) for each pole that is moved after the rounding
    direction, turns, texture, lines, marked, cones, evenness, effort, options, threads, progress : as in
        `automatic_map`

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
    mains = [main] * len(parts) if isinstance(main, str) else main
    chosen = {"poles": poles, "allowed": allowed, "moves": moves, "marked": marked, "cones": cones, "size": None}
    chosen |= {"direction": direction, "turns": asked_turns(turns, texture), "lines": lines, "evenness": evenness}
    request = Request(tiles=tiles or None, density=density, effort=effort, **chosen, **options)
    own = [replace(request.on_part(part), main=name) for part, name in zip(parts, mains)]
    asked = [*zip(own, parts, structures or [None] * len(parts))]
    ((made, _),) = map_objects([asked], request.size_of(parts), threads, progress)
    for found in made:
        if isinstance(found, MemoryError):
            raise found
    return made


def form_map(
    surface: Surface,
    structure: AnyStructure,
    why: str = "it was asked for",
    *,
    evenness: float = 0.0,
    progress: Progress | None = None,
) -> Map:
    """The `Map` of the balanced combination of a structure's forms.

    surface : the connected part, whose polygon corners are those that were solved on
    evenness : from 0 for a conformal map to 1 for squares of nearly one size, which are sheared instead. Jumps stay,
        and so do straight and round boundaries
    progress : as in `conformal_structure`

    Raises ValueError for an evenness outside 0 to 1; SolverError; Cancelled.
    Source: Gu, Wang, Yau (2003), § 7, for combinations; evening is ours, docs/method/evening.md.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> structure = holomorph.conformal_structure(surface)
    >>> print(holomorph.form_map(surface, structure).kind)
    forms
    """
    evenness = checked_evenness(evenness)
    check_type(why, str, "why")
    asked = {"evenness": evenness, "is_upright": False, "why": why}
    made = _native.form_map(structure._core, **asked, threads=structure._threads, progress=progress)
    return Map.of_core(made, surface, structure)


def island_map(
    surface: Surface, *, evenness: float = 0.0, threads: int = 0, progress: Progress | None = None
) -> Map | None:
    """The `Map` of a connected surface in flat islands; None where a piece cannot be flattened, as where it is closed.

    The surface is cut along edges where it breaks off by more than 60 degrees, a bevel once, and by more than 40 and
    30 where pieces stretch or lie over themselves, whichever looks best; from tips to these edges, and until all pieces
    are disks but for small holes. Each is mapped with a free boundary and evened; where lengths change by more
    than a factor of 2.5, it is cut open to its cone points too if that looks better, and parted where it lies over
    itself. Pieces are turned upright, and those that fit edge to edge are joined: first those that stay upright, longer
    edges first.

    Parameters
    ----------
    surface : Surface with positions
    evenness : as in `Structure.tile`
    threads, progress : as in `conformal_structure`

    Raises TopologyError for several components, and for a surface without positions; Cancelled.
    Source: Sawhney & Crane (2017), section 4, for each piece; cuts and joints are ours, docs/choice.md.

    Examples
    --------
    >>> corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    >>> cube = holomorph.Surface(corners, sides)
    >>> found = holomorph.island_map(cube)
    >>> print(found.islands, len(found.seams))
    1 7
    """
    check_type(surface, Surface)
    component = only_component(surface)
    if surface.vertices is None:
        raise TopologyError("islands need a surface with positions; this one has edge lengths only")
    threads = check_threads(threads or None)
    asked = {"evenness": checked_evenness(evenness), "threads": threads, "progress": scaled(progress, 0.0, 0.0)}
    made = _native.island_map(part_of(surface, component), **asked)
    return made and Map.of_core(made, surface, LateStructure(surface, surface, threads))
