"""The maps of one mesh by a recipe: those of its parts, side by side in the UV plane."""

from dataclasses import dataclass, field

import numpy as np

from .._native import Error, TopologyError
from ..automatic_map import automatic_maps
from ..automatic_structure import automatic_structure
from ..cut import cut_along
from ..disk import disk_map, free_boundary_map, rectangle_map
from ..log_map import log_map
from ..map import Map
from ..plain_data import plain
from ..report import component_report, map_report, refused_report, skipped_report
from ..structure import conformal_structure


@dataclass(eq=False)
class Part:
    """A connected part; `reason` says why it has no `map`."""

    surface: object
    structure: object = None
    map: Map | None = None
    reason: str = ""
    is_chosen: bool = False  # whether the recipe chooses something about its structure
    report: dict = field(default_factory=dict)


def map_parts(surface, recipe, cut_edges=None, threads=None):
    """A `Part` for each component, in the library's order. cut_edges : (#S, 2) vertices of the file.

    Raises TopologyError for chosen vertices that lie on no part, MemoryError."""
    parts = [Part(component) for component in surface.components]
    _check_chosen(surface, recipe.maps)
    for part in parts:
        try:
            _solve(part, recipe.maps, cut_edges, threads)
        except MemoryError:  # of the asset, not of this part
            raise
        except Error as error:
            part.reason = str(error)
    _map([part for part in parts if part.structure is not None], recipe)
    for part in parts:
        part.report = _report(part)
    return parts


def refused_reports(surface):
    """Those of the parts of the file that are no surface."""
    return [refused_report(refused) for refused in surface.refused]


def _check_chosen(surface, maps):
    for vertex in (*maps.poles, *maps.rectangle_corners):
        if not np.any(surface.vertex_index == vertex):
            raise TopologyError(f"vertex {vertex}, which the recipe chooses, lies on no part of the mesh")


def _solve(part, maps, cut_edges, threads):
    options = {"solver": maps.solver, "threads": threads}
    part.structure = _chosen_structure(part.surface, maps, options)
    cuts = _own_edges(part.surface, cut_edges) if maps.cut_at_seams else None
    part.is_chosen = part.structure is not None or maps.solver == "paper" or (cuts is not None and len(cuts) > 0)
    if part.structure is None:
        part.structure = automatic_structure(part.surface, memory_limit=maps.memory_limit, **options)
    if cuts is not None:
        part.structure = cut_along(part.structure, cuts)


def _chosen_structure(surface, maps, options):
    """What the recipe chooses for a part; None where it chooses nothing."""
    poles, taken = _own(surface, maps.poles)
    corners, _ = _own(surface, maps.rectangle_corners)
    is_disk = (surface.genus, surface.boundary_count) == (0, 1)
    if corners:
        return rectangle_map(surface, corners, **options)
    if is_disk and len(poles) == 1 and not maps.residues:
        return disk_map(surface, poles[0], **options)
    if poles:
        residues = [complex(*np.atleast_1d(maps.residues[index])) for index in taken] if maps.residues else None
        return log_map(surface, poles, residues, memory_limit=maps.memory_limit, **options)
    if maps.boundary == "free" and surface.boundary_count:
        return free_boundary_map(surface, **options)
    if maps.boundary == "double_cover" and surface.boundary_count:
        return conformal_structure(surface, boundary="double_cover", memory_limit=maps.memory_limit, **options)
    return None


def _own(surface, vertices):
    """Those of the file's vertices that lie on a part, as it counts them; and their places in the list."""
    found = [np.flatnonzero(surface.vertex_index == vertex) for vertex in vertices]
    return [int(own[0]) for own in found if own.size], [place for place, own in enumerate(found) if own.size]


def _own_edges(surface, edges):
    """The edges of the file whose ends lie on a part, as it counts them."""
    if edges is None or not len(edges):
        return None
    order = np.argsort(surface.vertex_index)
    places = np.searchsorted(surface.vertex_index, edges, sorter=order).clip(max=len(order) - 1)
    own = order[places]
    return own[(surface.vertex_index[own] == edges).all(axis=1)]


def _map(parts, recipe):
    """A map that was chosen, turned or scaled is no tiling unless one is asked for."""
    maps, wanted = recipe.maps, recipe.tiling
    is_plain = maps.density == 1 and maps.rotation == 0
    is_kept = [maps.main == "automatic" and (part.is_chosen or not is_plain) for part in parts]
    made = automatic_maps(
        [part.surface for part in parts],
        [part.structure for part in parts],
        main=["balanced" if kept else maps.main for kept in is_kept],
        tiles=wanted.tiles or None,
        density=wanted.density,
        poles=wanted.poles,
        lattice=wanted.lattice,
        direction=None if wanted.direction == "none" else wanted.direction,
        boundary=wanted.boundary,
        turn=wanted.turn,
        max_turn=wanted.max_turn,
        max_added=wanted.max_added,
    )
    for part, found in zip(parts, made):
        if isinstance(found, Map):
            part.map = found
        else:
            part.reason = str(found)


def _report(part):
    if part.map is None:
        return skipped_report(part.surface, part.reason)
    found = part.map
    main = map_report(found.coefficients, found.quality, found.verdict) | {"kind": found.kind, "why": found.why}
    entry = component_report(part.surface, found.structure, main)
    return entry | {"tiling": _tiling_report(part)} if found.tiling else entry


def _tiling_report(part):
    made, index = part.map.tiling, part.surface.vertex_index
    zeros, orders = made.zeros
    return plain(
        {
            "added_distortion": float(made.added_distortion),
            "density_ratio": float(made.density_ratio),
            "beltrami_rms": float(made.beltrami_rms),
            "tiles": float(made.tiles),
            "poles": index[made.poles],
            "residues": made.residues,
            "zeros": index[zeros],
            "orders": np.asarray(orders),
            "periods": np.asarray(made.periods),
        }
    )
