"""How much of the plane a map covers twice."""

from .. import _native
from ..core.array_types import Complexes, Progress


def overlapping_part(curve: Complexes, progress: Progress | None = None) -> float:
    """The part of the region around which closed curves wind that they wind around more than once: 0 where the map that
    they bound lies beside itself nowhere. See uv/quality.h.

    curve : (n, 2) complex ends of directed edges, which make closed curves
    progress : is asked whether to go on
    """
    return _native.overlapping_part(curve, progress)
