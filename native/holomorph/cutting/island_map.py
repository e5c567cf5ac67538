"""The map of a part in islands: cut along hard edges, each piece flattened, pieces laid edge to edge as a paper net."""

from __future__ import annotations

import math

from .. import _native
from .._native import TopologyError
from ..core.array_types import Progress
from ..core.progress import scaled
from ..mesh.checks import check_threads, check_type, checked_evenness
from ..mesh.surface import Surface
from .island_layout import Islands


def island_map(
    surface: Surface,
    *,
    evenness: float = 0.0,
    threads: int = 0,
    progress: Progress | None = None,
) -> Islands | None:
    """The `Islands` of a connected surface; None where a piece cannot be flattened, as where it is closed.

    The surface is cut along edges where it breaks off by more than 60 degrees, a bevel once, and by more than 40 and
    30 where pieces stretch or lie over themselves, whichever looks best; from tips to these edges, and until all pieces
    are disks but for small holes. Each is mapped with a free boundary and evened; where lengths change by more
    than a factor of 2.5, it is cut open to its cone points too if that looks better, and parted where it lies over
    itself. Pieces are turned upright, and those that fit edge to edge are joined: first those that stay upright, longer
    edges first.

    Parameters
    ----------
    surface : Surface with positions
    evenness : as in `Structure.tile`
    threads, progress : as in `conformal_structure`

    Raises TopologyError for several components, and for a surface without positions; Cancelled.
    Source: Sawhney & Crane (2017), section 4, for each piece; cuts and joints are ours, docs/choice.md.

    Examples
    --------
    >>> corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    >>> cube = holomorph.Surface(corners, sides)
    >>> found = holomorph.island_map(cube)
    >>> print(found.count, len(found.seams))
    1 7
    """
    check_type(surface, Surface)
    surface.require_connected()
    if surface.vertices is None:
        raise TopologyError("islands need a surface with positions; this one has edge lengths only")
    evenness, threads = checked_evenness(evenness), check_threads(threads or None)
    return IslandSearch(surface, evenness, threads, True).best(progress=progress)


class IslandSearch:
    """The islands of a surface, looked for as far as they are worth it; flat/island_search.h."""

    def __init__(self, surface, evenness, threads, is_upright):
        self._surface, self._threads, self._known = surface, threads, None
        self._native = _native.IslandSearch(surface._native, evenness, surface.up, is_upright)

    @property
    def known(self) -> Islands | None:
        """The best that was found."""
        return self._made(self._native.known)

    def best(self, most: float = math.inf, work: float = math.inf, progress: Progress | None = None) -> Islands | None:
        """The `Islands` of least cost, if it is below `most`, and they are found by so much work. What was found for
        other bounds is taken where it does.

        work : in millionths of about a second of one processor"""
        return self._made(self._native.best(most, work, self._threads, scaled(progress, 0.0, 0.0)))

    def at_once(self, most: float, progress: Progress | None = None) -> Islands | None:
        """Those of least cost but for hard seams and direction, if it is below `most`. Quick."""
        return self._made(self._native.at_once(most, self._threads, scaled(progress, 0.0, 0.0)))

    def _made(self, found):
        """One object for one result."""
        if found is None:
            return None
        if self._known is None or self._known[0] is not found:
            self._known = found, Islands.of(found, self._surface)
        return self._known[1]
