"""Where the rows of a texture run: along a vector in space, or level, so that the texture stands upright."""

import math

import numpy as np

from .._native import InvalidMesh
from ..core import arrays
from ..core.value import quoted

UPRIGHT = "upright"
UP = {"Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}  # by `Surface.up`


def along(direction, turn, surface):
    """(vector or None, turn or None) of a tiling of `surface`: u is to run along the vector and be rotated by `turn`.

    direction : None, (3,) numbers, or "upright": u then runs along what is up (`Surface.up`) and is turned by a
        quarter, so that v runs up as far as it can. A surface without positions is not turned: it knows no direction
    turn : radians, or None

    Raises ValueError for another direction; InvalidMesh for a vector on a surface without positions."""
    if isinstance(direction, str):
        if direction != UPRIGHT:
            raise ValueError(f'direction is {quoted(direction)}; "{UPRIGHT}", three numbers or None is needed')
        return (list(UP[surface.up]), math.pi / 2 + (turn or 0.0)) if surface.vertices is not None else (None, turn)
    return (None if direction is None else _vector(direction, surface)), turn


def _vector(direction, surface):
    if surface.vertices is None:
        raise InvalidMesh("an intrinsic surface, without positions, has no direction in space; use turn")
    vector = arrays.numbers(direction, "direction")
    if vector.shape != (3,) or not np.isfinite(vector).all() or not vector.any():
        raise ValueError(f"direction is {quoted(direction)}; three numbers, not all 0, are needed")
    return vector.tolist()
