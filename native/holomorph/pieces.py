"""The pieces of a part between its hard edges, and those that whole tiles would suit better than flat islands."""

import math
from dataclasses import dataclass

import numpy as np

from .appearance import cost
from .array_types import Integers
from .cut_open import cut_open
from .edges import edge_keys
from .hard_edges import TIP, bends, curvature, seen
from .island_cuts import edges_between, in_one_orientation
from .island_map import Islands
from .map_choice import FLAT, MOST_SOFT
from .origin import Origin
from .quality import Quality
from .surface import Surface
from .tube import is_tube

WORTH = 0.03  # part of the area, from which on a piece is looked at by itself
SMOOTH = 1.0  # radians of curvature without tips, from which on a piece that is no tube is more than sheets and cones
TUBES = 0.5  # part of the area of a part without islands, from which on its tubes are looked at


@dataclass(frozen=True)
class Piece:
    """A connected piece, whose surface counts vertices, polygons and corners as the part does. name : that of its
    polygons; cost : of its islands, see `appearance.cost`; infinite without any"""

    surface: Surface
    name: int
    cost: float


def names_of_pieces(surface, is_hard_edge):
    """(#F,) the piece of each polygon: hard edges that end within one do not divide it."""
    return np.asarray(cut_open(surface, is_hard_edge)._native.face_component)


def cut_apart(surface: Surface, names: Integers) -> tuple[Surface, ...]:
    """The components of a surface that is cut between polygons of different names, (#F,). They count as it does."""
    oriented, order = in_one_orientation(surface)
    origin = Origin(corner_index=order.astype(np.int32), vertex_count=len(surface.vertices))
    return cut_open(Surface._of(oriented._native, origin), edges_between(oriented, names)).components


def smooth_pieces(surface, flat, names, threads):
    """The `Piece`s that are tubes, or smooth, and across which islands have a seam or stretch."""
    found = []
    for part in cut_apart(surface, names):
        if part.area < WORTH * surface.area or not _may_be_smooth(part, flat):
            continue
        soft, own, squares = _costs(part, flat, threads)
        if soft * math.sqrt(part.area / surface.area) > MOST_SOFT or squares > FLAT:
            found.append(Piece(part, int(names[part.face_index[0]]), own))
    tubes = sum(piece.surface.area for piece in found)
    return found if flat or tubes >= TUBES * surface.area else []


def _may_be_smooth(part, flat):
    return is_tube(part) or flat is not None and part.boundary_count > 0 and curvature(part, TIP) > SMOOTH


def _costs(part, flat: Islands | None, threads):
    """(length of seams across the smooth, cost of all, of squares alone) that islands have on a piece."""
    if flat is None:
        return math.inf, math.inf, math.inf
    quality = Quality.of(part._native, flat.uv[part.corner_index], threads)
    native, count = part._native, part.given_vertex_count
    is_inner = np.bincount(native.triangle_edges.ravel(), minlength=len(native.edges)) == 2
    is_seam = np.isin(edge_keys(part.vertex_index[native.edges], count), edge_keys(flat.seams, count)) & is_inner
    soft = float((native.edge_lengths * seen(bends(part)))[is_seam].sum()) / math.sqrt(part.area)
    return soft, cost(quality, 0, soft), cost(quality)
