"""The maps of all parts of a mesh: `automatic_map` for each, all with squares of one size."""

from __future__ import annotations

import math
import numbers
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.array_types import Progress
from ..core.arrays import integer
from ..core.progress import scaled
from ..core.side_by_side import side_by_side
from ..core.value import quoted
from ..mesh.checks import check_list, check_type, real_number
from ..mesh.copies import Copy, copies
from ..mesh.given_vertices import on_part
from ..mesh.surface import Surface
from ..tiling.tiling import Poles
from .automatic_structure import AnyStructure
from .map import Map
from .map_choice import EVENNESS, REFUSALS, SOLVING, Refusal, Undecided, first_map
from .mixed_sizing import Divided, MixedSizing, divided
from .sizing import TRIES, Sizing, best_window, relative_size, usual_density, window_around

LEADING = 0.25  # part of the area of the largest part, from which on a part may say the density of all
TRYING = 0.9  # part of the work on tilings, for numbers of tiles
TOLERANCE = 0.2  # of a density that is given, a tenth of lengths: less is seen of that than of a seam
SCALE_DIGITS = 3  # to which the logarithm of a copy's scale is rounded: parts that differ by less have the same tiles


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
    common = {"direction": direction, "evenness": evenness} | options
    choices = [_own_choices(part, poles, allowed, moves) for part in parts]
    choices = [(own, common | more) for own, more in choices]
    size = {"tiles": tiles, "density": density, "tolerance": density_tolerance}
    return sized_maps(parts, structures, mains, choices, **size, threads=threads, progress=progress)


def sized_maps(
    parts: Sequence[Surface],
    structures: Sequence[AnyStructure] | None,
    mains: Sequence[str],
    choices: Sequence[tuple[Poles, dict[str, Any]]],
    tiles: float | None,
    density: float | None,
    tolerance: float,
    threads: int | None,
    progress: Progress | None,
) -> list[Map | Refusal]:
    """Like `automatic_maps`, with poles and other options of `Structure.tile` for each part, in the part's own
    vertices."""
    if tiles is not None and density is not None:
        raise ValueError("give tiles or a density, not both")
    if real_number(tolerance, "density_tolerance") < 0:
        raise ValueError(f"density_tolerance is {quoted(tolerance)}; it cannot be negative")
    tiles = tiles and real_number(tiles, "tiles", positive=True)
    density = None if density is None else real_number(density, "density", positive=True)
    alike = _alike(parts, mains, choices)
    done = SOLVING if structures is None else 0.0
    made = _first_maps(parts, structures, mains, alike, choices, threads, scaled(progress, 0.0, done))
    kinds = {Undecided: Sizing, Divided: MixedSizing}
    sizings = {k: kinds[type(found)](found, *choices[k]) for k, found in made.items() if type(found) in kinds}
    wanted = _density(parts, tiles) if density is None else density
    tries, near = TRIES if tiles or density is not None else 1, math.inf if density is None else tolerance
    sized = _sized(parts, alike, sizings, wanted, tries, near, threads, scaled(progress, done, 1.0))
    found = [sized[k] if k in sized else made[copy.first] for k, copy in enumerate(alike)]
    return [
        one if alike[k].first == k else _of_copy(one, parts[k], structures and structures[k], alike[k].scale)
        for k, one in enumerate(found)
    ]


def _density(parts, tiles):
    area = sum(part.area for part in parts)
    return tiles / area if tiles and area > 0 else usual_density(parts)


def _alike(parts, mains, choices):
    """The `Copy` that each part is. Parts of which something else is asked are not copies. Nor are those
    that are turned about the vertical if u is to run along a vector."""
    if any(not isinstance(options["direction"], (str, type(None))) for _, options in choices):
        return [Copy(k) for k in range(len(parts))]
    asked = [(main, repr(choice)) for main, choice in zip(mains, choices)]
    return [copy if asked[k] == asked[copy.first] else Copy(k) for k, copy in enumerate(copies(parts))]


def _first_maps(parts, structures, mains, alike, choices, threads, progress):
    """{part: result of `first_map`, or its error}, without copies."""
    firsts = [k for k, copy in enumerate(alike) if copy.first == k]

    def work(i, count, step):
        k = firsts[i]
        try:
            evenness = choices[k][1]["evenness"]
            found = first_map(parts[k], structures and structures[k], mains[k], evenness, count, step)
            return divided(found, evenness, count, step) if mains[k] == "automatic" else found
        except REFUSALS as error:
            return error

    found = side_by_side(work, [len(parts[k].triangles) for k in firsts], threads, progress)
    return dict(zip(firsts, found))


def _sized(parts, alike, sizings, density, tries, near, threads, progress):
    """{part: its map or its error} of parts that may get tilings. Those of copies are maps of the first part.

    tries : numbers of tiles that are tried on the largest part
    near : relative difference from `density`, up to which the density of that is then the one of the others"""
    if not sizings:
        return {}
    members = [k for k, copy in enumerate(alike) if copy.first in sizings]
    names = {k: (alike[k].first, round(math.log(alike[k].scale), SCALE_DIGITS)) for k in members}
    areas, largest = _areas(parts, names), _leader(parts, alike, sizings, members)
    share, made = 0.0, {}
    if near:
        share, sizing = parts[largest].area / (sum(areas.values()) or 1.0), sizings[alike[largest].first]
        share *= 1.0 if math.isinf(near) else 0.5  # the rest is for another map of this part
        wanted = _on_first(density, alike[largest])
        leader = sizing.about(wanted, tries, scaled(progress, 0.0, share))
        is_tiled = isinstance(leader, Map) and leader.is_tiled
        is_near = is_tiled and abs(relative_size(leader, wanted) - 1) <= near
        if is_near:
            density = leader.density / alike[largest].scale ** 2
        if is_near or math.isinf(near):
            made[names[largest]] = leader
    wanted = {names[k]: _on_first(density, alike[k]) for k in reversed(members) if names[k] not in made}
    made |= _of_one_size(parts, sizings, wanted, areas, not made, threads, scaled(progress, share, 1.0))
    return {k: made[names[k]] for k in members}


def _areas(parts, names):
    """{name: total area of the parts with that name}."""
    areas = dict.fromkeys(names.values(), 0.0)
    for k, name in names.items():
        areas[name] += parts[k].area
    return areas


def _leader(parts, alike, sizings, members):
    """The part that says the density of all: the largest, or, where pieces of that may have any density, the largest
    other one, if it is no smaller than `LEADING` of it."""
    largest = max(members, key=lambda k: parts[k].area)
    whole = [k for k in members if isinstance(sizings[alike[k].first], Sizing)]
    leader = max(whole, key=lambda k: parts[k].area, default=largest)
    return leader if parts[leader].area >= LEADING * parts[largest].area else largest


def _of_one_size(parts, sizings, wanted, areas, is_given, threads, progress):
    """{(part, scale): its map or how it is refused} for densities by these. One of each part is tried before the
    others: it places the poles for all."""
    leading = list({name[0]: name for name in wanted}.values())
    following = [name for name in wanted if name not in set(leading)]

    def done(names, work, start, end):
        sizes = [len(parts[name[0]].triangles) for name in names]
        made = side_by_side(
            lambda i, _threads, step: work(names[i], step), sizes, threads, scaled(progress, start, end)
        )
        return dict(zip(names, made))

    def tried(name, step):
        return sizings[name[0]].tried(wanted[name], TRIES, step)

    found = done(leading, tried, 0.0, TRYING / 2) | done(following, tried, TRYING / 2, TRYING)
    sizes = {name: [relative_size(made, wanted[name]) for made in each.tilings] for name, each in found.items()}
    window = window_around() if is_given else best_window(list(sizes.values()), [areas[name] for name in sizes])

    def settled(name, step):
        return sizings[name[0]].settled(found[name], wanted[name], window, step)

    return done(list(wanted), settled, TRYING, 1.0)


def _on_first(density, copy):
    """The density of a copy's map on the first part."""
    return density * copy.scale**2


def _of_copy(found, part, structure, scale):
    """The map of a copy of its part."""
    return found.of_copy(part, structure, scale) if isinstance(found, Map) else found


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
    places, is_there = on_part(part, integer([vertex for _, vertex in moves], "moves"))
    own = {pole: int(place) for (pole, _), place, has in zip(moves, places, is_there) if has}
    return poles, {"allowed": allowed, "moves": own}
