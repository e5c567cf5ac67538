"""The pieces of a part between its hard edges, and those that whole tiles would suit better than flat islands.
Windows in tubes, such as where a handle is fixed, are closed for the map.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from .. import _native
from ..core import arrays
from ..core.array_types import Flags, Integers, Progress, Reals
from ..cutting.island_layout import Islands
from ..mesh.edges import boundary_edges, edge_keys
from ..mesh.hard_edges import TIP, breaks, curvature
from ..mesh.origin import Origin
from ..mesh.surface import Surface
from ..quality.appearance import cost, of_squares
from ..quality.quality import Quality
from ..tiling.tilings import UP
from .map import Map
from .untiled import FLAT, MOST_CURVED, MOST_SOFT

REST = _native.rest  # name of polygons that are looked at with others
SMOOTH = 1.0  # radians of curvature without tips, from which on a piece that is not a tube is more than sheets, cones
TUBES = 0.5  # part of the area of a part without islands, from which on its tubes are looked at
ENDS = 2  # the longest boundary loops of a tube


@dataclass(frozen=True)
class Piece:
    """A connected piece, whose surface counts vertices, polygons and corners as the part does.

    name : that of its polygons
    uv, cost : of its islands, (#C, 2), see `appearance.cost`; None and infinite without any
    """

    surface: Surface
    name: int
    uv: Reals | None
    cost: float

    def turn(self, uv: Reals) -> float:
        """Radians by which rows of squares of the islands turn against those of another map of the piece, in the mean
        over the area; 0 without islands."""
        return 0.0 if self.uv is None else _native.turn_between(self.surface._native, self.uv, uv)


def names_of_pieces(surface: Surface, is_hard_edge: Flags) -> Integers:
    """(#F,) the piece of each polygon, from 0 on: hard edges, (#E,), that end within one do not divide it. Those of
    little area are `REST`."""
    return _native.names_of_pieces(surface._native, is_hard_edge)


def cut_apart(surface: Surface, names: Integers) -> tuple[Surface, ...]:
    """The components of a surface that is cut between polygons of different names, (#F,). They count as it does."""
    return _parts_of(surface, _native.cut_apart(surface._native, names))


def cut_in_hiding(
    surface: Surface, is_upright: bool, threads: int, progress: Progress | None
) -> tuple[Piece, float] | None:
    """(The surface cut open between its tips where few see it, as a `Piece` with the name 0; how far the cut is seen).
    None where it would fall apart. See native/src/mesh/hidden_cut.h."""
    up = UP[surface.up] if is_upright else None
    parts, seen = _native.cut_in_hiding(surface._native, up, threads=threads, progress=progress)
    return (Piece(_parts_of(surface, parts)[0], 0, None, math.inf), seen) if len(parts) == 1 else None


def _parts_of(surface, parts):
    count = len(surface.vertices)
    return tuple(Surface._of(native, Origin(*own, vertex_count=count, up=surface.up)) for native, *own in parts)


def smooth_pieces(surface: Surface, flat: Islands | None, names: Integers, threads: int) -> list[Piece]:
    """The `Piece`s with `names_of_pieces` that are tubes, or smooth, and across which islands have a seam or stretch,
    the largest first."""
    parts = [(part, int(names[part.face_index[0]])) for part in cut_apart(surface, names)]
    found = []
    for part, name in sorted(parts, key=lambda pair: -pair[0].area):
        if name == REST:
            continue
        piece, soft, squares = _piece(part, name, flat, threads)
        if _may_be_smooth(part, flat) and (soft > MOST_SOFT * math.sqrt(surface.area) or squares > FLAT):
            found.append(piece)
    tubes = sum(piece.surface.area for piece in found)
    return found if flat or tubes >= TUBES * surface.area else []


def _may_be_smooth(part, flat):
    curved = curvature(part, most=TIP)
    is_round = part.genus == 0 and part.boundary_count > 1  # a tube, perhaps with windows
    return curved <= MOST_CURVED and (is_round or flat is not None and part.boundary_count > 0 and curved > SMOOTH)


def _piece(part, name, flat, threads):
    """(`Piece`, length of the seams of islands across the smooth, what is minded of their squares)"""
    if flat is None:
        return Piece(part, name, None, math.inf), math.inf, math.inf
    uv = np.ascontiguousarray(flat.uv[part.corner_index])
    quality = Quality.of(part._native, uv, threads)
    quality = quality.upright(uv, part.up) if flat.quality.direction else quality
    native, count = part._native, part.given_vertex_count
    is_inner = np.bincount(native.triangle_edges.ravel(), minlength=len(native.edges)) == 2
    is_seam = np.isin(edge_keys(part.vertex_index[native.edges], count), edge_keys(flat.seams, count)) & is_inner
    soft = float((native.edge_lengths * _native.seen(breaks(part)))[is_seam].sum())
    return Piece(part, name, uv, cost(quality, 0, soft / math.sqrt(part.area))), soft, of_squares(quality)


def is_tube(surface: Surface) -> bool:
    """Whether the surface is a sphere with two holes."""
    return (surface.genus, surface.boundary_count) == (0, ENDS)


def closed(surface: Surface) -> Surface:
    """The surface with one more polygon, at the end, in each boundary loop but the `ENDS` longest; itself where there
    are no more. Vertices, polygons and corners keep their numbers.

    Raises InvalidMesh where a window is not a polygon.
    """
    if surface.boundary_count <= ENDS:
        return surface
    return Surface._of(_native.without_windows(surface._native))._standing_as(surface)


def opened(made: Map, surface: Surface) -> Map:
    """The tiling of a surface with closed windows, on the surface itself."""
    if made.surface is surface:
        return made
    uv = arrays.frozen(made.uv[: len(surface.corner_vertices)])
    before = made.quality.direction
    quality = replace(Quality.of(surface._native, uv, 0), unseen_angle=made.quality.unseen_angle)
    quality = quality.upright(uv, surface.up, before.turns) if before else quality
    tiling = replace(_inside(made.tiling, surface), uv=uv, quality=quality)
    return replace(made, surface=surface, uv=uv, quality=quality, tiling=tiling)


def _inside(tiling, surface):
    """The tiling without the seams that ran through windows, and the cones at their rims."""
    count, rims = len(surface.vertices), boundary_edges(surface)
    is_inner = np.isin(edge_keys(surface._native.edges, count), edge_keys(rims, count), invert=True)
    is_seam = np.isin(edge_keys(tiling.seams, count), edge_keys(surface._native.edges[is_inner], count))
    is_cone = np.isin(tiling.cones, rims, invert=True)
    parts = {"seams": tiling.seams[is_seam], "cones": tiling.cones[is_cone], "cone_angles": tiling.cone_angles[is_cone]}
    parts["jumps"] = tiling.jumps[is_seam] if len(tiling.jumps) else tiling.jumps
    return replace(tiling, **{name: arrays.frozen(values) for name, values in parts.items()})
