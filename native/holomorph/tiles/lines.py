"""Lines of a tiling as curves on the surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..core.array_types import Flags, Integers, Reals
from ..core.value import counted
from .surface_points import SurfacePoints

if TYPE_CHECKING:
    from .tiled_surface import TiledSurface


@dataclass(frozen=True, eq=False, repr=False)
class Lines(SurfacePoints):
    """Result of `TiledSurface.lines`: polylines on the surface, with a point on each edge that they cross. All arrays
    are read-only.

    offsets : (#L + 1,) line l has the points from ``offsets[l]`` to ``offsets[l + 1]``
    is_closed : (#L,) bool: the last point is joined to the first. Others end on the boundary, at the star of a pole, or
        at a vertex where the map branches or folds on a line
    triangles : (n,) of `surface.triangles`, in which each point lies, on an edge
    barycentric : (n, 3) coordinates there
    tiled : the `TiledSurface`
    """

    offsets: Integers
    is_closed: Flags
    triangles: Integers
    barycentric: Reals
    tiled: TiledSurface

    def __len__(self) -> int:
        return len(self.is_closed)

    def _facts(self):
        return [counted(len(self), "line"), f"{int(self.is_closed.sum())} closed"]
