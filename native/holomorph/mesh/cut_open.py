"""Surfaces cut open along their edges."""

from __future__ import annotations

import numpy as np

from .. import _native
from ..core import arrays
from ..core.array_types import Integers
from .origin import Origin
from .surface import Surface


def cut_open(surface, is_seam):
    """Cuts the surface open along the edges of this mask, (#E,), but leaves no sliver without the neighbour at its
    longest side: no part is without area."""
    native, index = _native.cut_open(surface._native, is_seam)
    vertex_index = arrays.frozen(surface.vertex_index[index])
    origin = Origin(vertex_index, surface.face_index, surface.corner_index, surface.given_vertex_count, up=surface.up)
    return Surface._of(native, origin)


def next_sides(sides: Integers) -> Integers:
    """The side that follows each one in its triangle, numbered through all triangles."""
    return np.where(sides % 3 == 2, sides - 2, sides + 1)
