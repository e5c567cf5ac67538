"""The maps of one mesh by a recipe: those of its parts, side by side in the UV plane."""

import math
from dataclasses import dataclass, field

import numpy as np

from .. import choice
from .._native import Error, TopologyError
from ..plain_data import plain
from ..report import component_report, map_report, refused_report, skipped_report
from ..structure import conformal_structure
from ..surface import Surface


@dataclass(eq=False)
class Part:
    """A connected part; `uv` (#C of the part, 2) and `quality` are those of its main map, `reason` says why it has
    none."""

    surface: Surface
    structure: object = None
    tiling: object = None
    uv: np.ndarray | None = None
    quality: object = None
    coefficients: np.ndarray = ()
    reason: str = ""
    report: dict = field(default_factory=dict)

    @property
    def unit_length(self):
        """On the surface, of a UV unit where the density is the median one."""
        density = self.quality.median_density
        return 1 / math.sqrt(density) if density > 0 else 0.0


def map_parts(surface, recipe, cut_edges=None, threads=None):
    """A `Part` for each component, in the library's order. cut_edges : (#S, 2) vertices of the file.

    Raises TopologyError for chosen vertices that lie on no part, MemoryError."""
    parts = [Part(component) for component in surface.components]
    _check_chosen(surface, recipe.maps)
    for part in parts:
        try:
            _solve(part, recipe, cut_edges, threads)
        except MemoryError:  # of the asset, not of this part
            raise
        except Error as error:
            part.reason = str(error)
    _tile(parts, recipe)
    for part in parts:
        part.report = _report(part)
    return parts


def refused_reports(surface):
    """Those of the parts of the file that are no surface."""
    return [refused_report(refused) for refused in surface.refused]


def _check_chosen(surface, maps):
    for vertex in (*maps.punctures, *maps.rectangle_corners):
        if not np.any(surface.vertex_index == vertex):
            raise TopologyError(f"vertex {vertex}, which the recipe chooses, lies on no part of the mesh")


def _solve(part, recipe, cut_edges, threads):
    maps = recipe.maps
    punctures, taken = _own(part.surface, maps.punctures)
    corners, _ = _own(part.surface, maps.rectangle_corners)
    residues = [complex(*np.atleast_1d(maps.residues[index])) for index in taken] if maps.residues else None
    part.structure = conformal_structure(
        part.surface,
        boundary=maps.boundary if part.surface.boundary_count else "natural",
        punctures=punctures or None,
        residues=residues or None,
        rectangle_corners=corners or None,
        cut_edges=_own_edges(part.surface, cut_edges) if maps.cut_at_seams else None,
        solver=maps.solver,
        threads=threads,
        memory_limit=maps.memory_limit,
    )
    part.coefficients = part.structure.balanced_coefficients()
    part.uv = part.structure.uv(part.coefficients)
    part.quality = part.structure.quality(part.uv)


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


def _tile(parts, recipe):
    """Tilings, where they are asked for and taken; all with the density of the largest, but for a number of tiles."""
    asked = sorted((part for part in parts if _asks_for_tiling(part, recipe.maps)), key=lambda part: -part.surface.area)
    total, density = sum(part.surface.area for part in asked), recipe.tiling.density
    for part in asked:
        tiles = recipe.tiling.tiles * part.surface.area / total if total > 0 else 0.0
        try:
            made = _taken_tiling(part, recipe, tiles or None, None if tiles else density)
        except MemoryError:
            raise
        except Error as error:
            part.structure, part.reason = None, str(error)
            continue
        if made is not None:
            part.tiling, part.uv, part.quality, part.coefficients = made, made.uv, made.quality, ()
            density = density or made.tiles / part.surface.area


def _asks_for_tiling(part, maps):
    if part.structure is None or part.surface.area == 0 or maps.main == "balanced":
        return False
    if maps.main == "seamless":
        return True
    is_plain = maps.density == 1 and maps.rotation == 0 and not (maps.punctures or maps.rectangle_corners)
    return is_plain and choice.is_worth_a_tiling(part.structure, part.quality.density_ratio)


def _taken_tiling(part, recipe, tiles, density):
    """The tiling that takes the place of the balanced map; None where that stays.

    @throws Error where a tiling was asked for and cannot be made"""
    wanted = recipe.tiling
    poles = wanted.poles
    if isinstance(poles, tuple):
        poles = _own(part.surface, poles)[0] or "auto"
    if recipe.maps.main == "seamless":
        return _tiling(part, wanted, poles, tiles, density)
    for tried in choice.POLES if poles == "auto" else (poles,):
        try:
            made = _tiling(part, wanted, tried, tiles, density)
        except MemoryError:
            raise
        except Error:
            continue
        if choice.is_better(made, part.quality.density_ratio, part.quality.capped_mean_angle):
            return made
    return None


def _tiling(part, wanted, poles, tiles, density):
    return part.structure.tile(
        tiles,
        density,
        poles,
        wanted.lattice,
        wanted.direction,
        wanted.boundary,
        wanted.max_turn,
        wanted.turn,
        wanted.max_added,
    )


def _report(part):
    if part.structure is None:
        return skipped_report(part.surface, part.reason)
    entry = component_report(
        part.surface, part.structure, map_report(part.coefficients, part.quality, part.tiling and part.tiling.verdict)
    )
    return entry | {"tiling": _tiling_report(part)} if part.tiling else entry


def _tiling_report(part):
    made, index = part.tiling, part.surface.vertex_index
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
