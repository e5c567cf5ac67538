"""Points of a surface, by triangles."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core import arrays
from ..core.array_types import Integers, Reals
from ..core.value import Value

if TYPE_CHECKING:
    from .tiled_surface import TiledSurface


class SurfacePoints(Value):
    """Base of what lies on a `TiledSurface`, its points given by triangles and coordinates there."""

    triangles: Integers
    barycentric: Reals
    tiled: TiledSurface

    def of(self, values: ArrayLike) -> NDArray[Any]:
        """(n, ...) values at the points, of (#V, ...) values at the vertices of the surface, such as its positions in
        another pose."""
        return np.einsum("ni,ni...->n...", self.barycentric, np.asarray(values)[self._corners])

    @cached_property
    def positions(self) -> Reals:
        """(n, 3) positions in space."""
        return arrays.frozen(self.of(self.tiled.surface.vertices))

    @cached_property
    def _corners(self):
        """(n, 3) vertices."""
        return self.tiled.surface.triangles[self.triangles]
