"""The zeros of holomorphic forms."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.array_types import Integers, Reals
from ..core.value import Value, counted


@dataclass(frozen=True, eq=False, repr=False)
class Zeros(Value):
    """The zeros of a differential, where its UV map branches.

    vertices : (k,) vertices of the surface. A zero that the mesh spreads over vertices and flipped triangles that touch
        is one, named by the vertex with the largest part; those in the star of a pole are named by a vertex around
        it
    orders : (k,) integers: around the vertex the map turns 2 pi (order + 1); on a boundary pi (order + 1). On a closed
        surface their sum is 2g - 2, with p poles 2g - 2 + p, exactly; with b boundary loops the orders on them and
        twice the others are 4g - 4 + 2b + 2p together. A negative order is a defect of a coarse
        map: beside it, zeros are too many
    positions : (k, 3) of the vertices; None on an intrinsic surface
    """

    vertices: Integers
    orders: Integers
    positions: Reals | None

    def _facts(self):
        return [counted(len(self.vertices), "zero"), f"the sum of their orders {int(self.orders.sum())}"]
