"""The maps of one mesh by a recipe: those of its parts, side by side in the UV plane, as its texture turns."""

import math
from dataclasses import asdict, dataclass, replace

import numpy as np

from .._native import Error, TopologyError, __version__
from ..core.value import plain
from ..files import textures
from ..maps import arrangement
from ..maps.automatic_map import automatic_maps
from ..maps.automatic_structure import automatic_structure
from ..maps.map import Map
from ..maps.report import parts_report
from ..mesh.origin import on_part
from ..tiles.height_image import height_image
from ..tiling.images import image_turns
from ..tiling.request import AUTO, AUTOMATIC, LINED_TURNS


@dataclass(eq=False)
class Part:
    """A connected part; `reason` says why it has no `map`."""

    surface: object
    structure: object = None  # where the recipe chooses something about it, until there is a map
    map: Map | None = None
    reason: str = ""
    is_chosen: bool = False  # whether that is more than how it is solved


def map_parts(surface, recipe, cut_edges=None, threads=None):
    """A `Part` for each component, in the library's order. cut_edges : (#S, 2) vertices of the file.

    Raises TopologyError for chosen vertices that lie on no part, MemoryError."""
    parts = [Part(component) for component in surface.components]
    _check_chosen(surface, recipe.maps)
    for part in parts:
        try:
            _solve(part, recipe.maps, cut_edges, threads)
        except MemoryError:  # the whole asset failed, not this part
            raise
        except Error as error:
            part.reason = str(error)
    _map([part for part in parts if not part.reason], recipe, threads)
    return parts


def report(surface, parts, recipe, texture=None, **names):
    """What is known of the mesh and its parts, see `parts_report`. texture : its `ImageTurns`; names : of the mesh"""
    given = [(part.surface, part.map, part.reason, "") for part in parts]
    return {
        "holomorph": __version__,
        **names,
        "faces": len(surface.face_offsets) - 1,
        "texture": plain(texture and vars(texture)),
        **parts_report(given, surface.refused, surface.repairs, arrangement_of(recipe.maps)),
    }


def main_uv(surface, parts, maps):
    """(#C, 2) of the whole surface; see `holomorph.arrangement`. Corners of parts without a map are 0."""
    made = [part.map for part in parts if part.map is not None]
    return arrangement.arranged(made, _corner_count(surface), arrangement_of(maps))[surface.corner_index]


def form_uvs(surface, parts, maps):
    """(#C, 2) for each form that gets a map of its own; parts that lack the form are 0 there."""
    done = [(part.surface, part.structure) for part in parts if part.map is not None]
    count = max((structure.form_count for _, structure in done), default=0)
    for form in range(min(maps.forms, count)):
        uv = arrangement.arranged_form(done, form, _corner_count(surface), arrangement_of(maps))
        yield uv[surface.corner_index]


def _corner_count(surface):
    """Corners of the file, up to the last one of the surface; `corner_index` of parts counts these."""
    return int(max(surface.corner_index.max(), surface._origin.repeated.max(initial=0))) + 1


def arrangement_of(maps):
    return arrangement.Arrangement(density=maps.density, rotation=math.radians(maps.rotation), margin=maps.margin)


def _check_chosen(surface, maps):
    for vertex in (*maps.poles, *maps.rectangle_corners):
        if not on_part(surface, [vertex])[1].all():
            raise TopologyError(f"vertex {vertex}, which the recipe chooses, lies on no part of the mesh")


def _solve(part, maps, cut_edges, threads):
    chosen = _choices(part.surface, maps, cut_edges if maps.cut_at_seams else None)
    part.is_chosen = maps.solver == "paper" or any(len(value) for value in chosen.values())
    if part.is_chosen or maps.solver != "auto" or maps.memory_limit:
        options = {"solver": maps.solver, "thresholds": maps.thresholds, "threads": threads}
        part.structure = automatic_structure(part.surface, **chosen, memory_limit=maps.memory_limit, **options)


def _choices(surface, maps, cut_edges):
    """What the recipe chooses for a part, as keywords of `automatic_structure`; "natural" boundaries are none."""
    places, is_own = on_part(surface, maps.poles)
    corners, is_corner = on_part(surface, maps.rectangle_corners)
    chosen = {"poles": places[is_own].tolist(), "corners": corners[is_corner].tolist()}
    if maps.residues and is_own.any():
        chosen["residues"] = [complex(*np.atleast_1d(maps.residues[place])) for place in np.flatnonzero(is_own)]
    if surface.boundary_count and maps.boundary != "natural":
        chosen["boundary"] = maps.boundary
    if cut_edges is not None and len(cut_edges):
        edges, is_own = on_part(surface, cut_edges)
        chosen["cuts"] = edges[is_own.all(axis=1)]
    return chosen


def _map(parts, recipe, threads):
    made = automatic_maps(
        [part.surface for part in parts],
        [part.structure for part in parts],
        main=[_main(part, recipe.maps) for part in parts],
        threads=threads,
        **_tiling_options(recipe.tiling),
    )
    for part, found in zip(parts, made):
        if isinstance(found, Map):
            part.map, part.structure = found, found.structure
        else:
            part.reason = str(found)


def _main(part, maps):
    """A map that was chosen, turned or scaled is not a tiling unless one is asked for."""
    is_plain = maps.density == 1 and maps.rotation == 0
    return maps.main if is_plain and not part.is_chosen or maps.main != "automatic" else "balanced"


def _tiling_options(wanted):
    direction = None if wanted.direction == "none" else wanted.direction
    return asdict(wanted) | {"tiles": wanted.tiles or None, "direction": direction}


def turned(recipe):
    """(the `Recipe` with a number of turns, where it leaves that to its texture, and the `ImageTurns` of the texture by
    its brightness, None where maps do not turn). Files repeat images in squares: those that look the same after a sixth
    turn have half turns there. Raises ValueError, OSError as `height_image`."""
    texture, tiling, found = recipe.output.texture, recipe.tiling, None
    if texture is not None and tiling.turns != 1:
        checker = np.kron(np.eye(2), np.ones((2, 2)))
        found = image_turns(checker if texture == textures.CHECKER else height_image(texture)[::-1])
        found = replace(found, turns=2) if found.turns == 6 else found
    if tiling.turns != AUTO:
        return recipe, found
    turns = found.turns if found else 1
    lines = tiling.lines if turns in LINED_TURNS else AUTOMATIC
    return replace(recipe, tiling=replace(tiling, turns=turns, lines=lines)), found


def moved(uv, surface, parts, recipe, found):
    """(#C, 2) UVs of files. Where a map turns, the centre of the texture's turns lies at the corners of tiles."""
    if found is None or all(part.map is None or part.map.turns == 1 for part in parts):
        return uv
    images = textures.checker_squares(surface, uv) / 2 if recipe.output.texture == textures.CHECKER else 1
    return uv + np.array(found.centre) / images
