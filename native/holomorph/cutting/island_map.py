"""The map of a part in islands: cut along hard edges, each piece flattened, pieces laid edge to edge as a paper net."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core import arrays
from ..core.array_types import Progress
from ..core.progress import scaled
from ..mesh.checks import check_threads, check_type, checked_evenness
from ..mesh.facets import breaks
from ..mesh.hard_edges import curvature
from ..mesh.surface import Surface
from ..quality.appearance import HARD_SEAM, SEAM, of_direction, of_squares
from ..quality.quality import Quality
from .island_cuts import Cuts, in_one_orientation
from .island_layout import Flattened, Islands, visible_lengths

HARD = 60.0, 40.0, 30.0  # degrees between two faces, from which on a seam is expected, if need be
SMOOTH = 35.0  # degrees: a part without sharper edges is a coarse mesh of something smooth
FINE = 0.3  # cost of the squares, from which on no other angle is tried
MANY = 1.0  # length of hard edges over the square root of the area, from which on these shape the part
FLAT = 2 * math.pi  # radians of curvature, all of it counted positive, up to which a part with several loops is tried
CONES, ROUNDS = 8, 4  # at most: cuts of each piece to cone points in a round, and rounds

# What remains in the end of what cuts and conformal squares cost, as it was seen on a dozen meshes.
LEAST_SEAMS = 0.8  # of the seams, at least: some pieces fit edge to edge
EVENED = 0.45  # of what is minded of the squares, about
HOPELESS = 2.0  # times the cost that is wanted at most: cuts to cone points hardly bring it there
EVEN = 1e-9  # of what is minded of conformal squares: evening leaves them as they are
PARTED = 0.1  # of overlaps at most: they may go, or are cut apart

ALIKE = 1.1  # times a bound: islands are not looked for again for a bound so near
FLATTENING, EVENING = 8, 15  # work for each triangle, in the unit of `IslandSearch.best`


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

    Raises Cancelled.
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
    evenness, threads = checked_evenness(evenness), check_threads(threads or None)
    return IslandSearch(surface, HARD, evenness, threads, True).best(progress=progress)


def one_island(surface, tiling):
    """The `Islands` of a map whose jumps are not whole tiles any more, since a UV unit is to be one of length."""
    size = math.sqrt(tiling.quality.median_density)
    ends = surface.vertices[tiling.seams]
    soft = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() / math.sqrt(surface.area)
    quality = tiling.quality.of_density(1.0)
    return Islands(arrays.frozen(tiling.uv / size), tiling.seams, 1, float(soft), 0.0, quality, tiling.evenness)


class _Candidate(NamedTuple):
    """A layout that may be worth evening. islands : the conformal ones, as they are laid out; rounds : of further cuts
    that may follow"""

    flattened: Flattened
    islands: Islands
    rounds: int


class IslandSearch:
    """The islands of a surface, looked for as far as they are worth it: along hard edges, then also to cone points and
    between what overlaps, for one angle of hard edges after the other. All is first laid out conformal, which is quick.
    Only what may be the best is evened."""

    def __init__(self, surface, angles, evenness, threads, is_upright):
        self.surface, (self._surface, self._order) = surface, in_one_orientation(surface)
        self._angles, self._evenness, self._threads, self._is_upright = angles, evenness, threads, is_upright
        self._bends = breaks(self._surface)
        self.known: Islands | None = None  # the best that was found
        self._asked = -math.inf, -math.inf  # the bounds for which they were looked for
        self._hopeless, self._is_quick, self._left, self._progress = math.inf, False, math.inf, None

    def best(self, most: float = math.inf, work: float = math.inf, progress: Progress | None = None) -> Islands | None:
        """The `Islands` of least cost, if it is below `most`, and they are found by so much work. What was found for
        other bounds is taken where it does.

        work : in millionths of about a second of one processor"""
        asked = most, work
        is_settled = self.known is not None and self._asked[1] == math.inf and self.known.cost < self._asked[0]
        if not is_settled and any(new > ALIKE * old for new, old in zip(asked, self._asked)):
            self._asked, self._left = asked, work
            self.known = self._search(most, progress) or self.known
        return self.known if self.known is not None and self.known.cost < most else None

    def at_once(self, most: float, progress: Progress | None = None) -> Islands | None:
        """Those of least cost but for hard seams and direction, if it is below `most`. Quick: what is `HOPELESS` is not
        cut to cone points."""
        self._hopeless, self._is_quick = HOPELESS * most, True
        try:
            self.known = self._search(most, progress)
        finally:
            self._hopeless, self._is_quick = math.inf, False
        return self.known

    def _search(self, most, progress):
        self._progress = scaled(progress, 0.0, 0.0)  # whether to go on; how long it takes is not known
        found = None
        for degrees in self._angles:
            if not self._is_tried(degrees, found is not None or degrees > SMOOTH):
                continue
            made = self._along(self._cuts(degrees), most if found is None else self._cost(found))
            found = made or found
            if found and of_squares(found.quality) <= FINE:
                break
        return found and self._as_given(found)

    def _cuts(self, degrees):
        return Cuts(self._surface, self._bends > np.radians(degrees), self._progress)

    def _is_tried(self, degrees, is_wanted):
        """Where no edge is hard a cut would be one through the smooth; but a disk, or what has little curvature, may be
        flat."""
        surface = self._surface
        if degrees == self._angles[0]:
            is_disk = (surface.genus, surface.boundary_count) == (0, 1)
            if is_disk or surface.boundary_count > 0 and curvature(surface) < FLAT:
                return True
        is_hard_edge = self._bends > np.radians(degrees)
        return is_wanted and surface._native.edge_lengths[is_hard_edge].sum() > MANY * math.sqrt(surface.area)

    def _along(self, cuts, most):
        """The best `Islands` from these cuts on that cost less than `most`, or None."""
        candidates, found = self._candidates(cuts, most, ROUNDS), None
        for _ in range(ROUNDS):
            worth = [one for one in candidates if self._guess(one) < most or math.isinf(most)]
            if not worth:
                break
            one = min(worth, key=self._guess)
            candidates.remove(one)
            made, uv = self._evened(one)
            if self._cost(made) < most:
                found, most = made, self._cost(made)
            if made.overlap_cost > 0:
                candidates += self._parted(one, uv, most)
        return found

    def _evened(self, candidate):
        """(`Islands`, UVs of the pieces before they are laid out)"""
        self._left -= EVENING * len(self._surface.triangles)
        flattened, conformal = candidate.flattened, candidate.islands
        if self._evenness == 0 or _squares(conformal) <= EVEN:
            return replace(conformal, evenness=self._evenness), flattened.evened(0.0)
        uv = flattened.evened(self._evenness)
        return flattened.laid_out(uv, self._evenness, conformal), uv

    def _candidates(self, cuts, most, rounds):
        """The `_Candidate`s of cuts, and of further ones to cone points."""
        result = []
        for left in range(rounds - 1, -1, -1):
            flattened = self._flattened(cuts, most)
            if flattened is None:
                break
            result.append(_Candidate(flattened, flattened.laid_out(flattened.evened(0.0), 0.0), left))
            if self._guess(result[-1]) >= self._hopeless or not self._cut_to_cones(cuts, flattened, most):
                break
        return result

    def _parted(self, candidate, uv, most):
        """The `_Candidate`s with further cuts across the overlaps that its pieces have with these UVs, if any."""
        cuts = candidate.flattened.cuts.copy()
        is_cut = cuts.add(cuts.across_overlaps(candidate.flattened.pieces, uv, self._progress))
        return self._candidates(cuts, most, candidate.rounds) if is_cut else []

    def _flattened(self, cuts, most):
        """None where seams alone cost too much, no work is left, or a piece has no flat map."""
        if LEAST_SEAMS * self._seam_cost(cuts) >= most or self._left <= 0:
            return None
        self._left -= FLATTENING * len(self._surface.triangles)
        return Flattened.of(cuts, self._bends, self._is_upright, self._threads, self._progress)

    def _cut_to_cones(self, cuts, flattened, most):
        """Whether there was a piece to cut; of each one after the other, until none stretches."""
        count = 0
        while flattened is not None and count < CONES and cuts.add(cuts.to_cones(flattened.pieces, flattened.flat)):
            flattened = self._flattened(cuts, most)
            count += 1
        return count > 0

    def _seam_cost(self, cuts):
        soft, hard = visible_lengths(self._surface, self._bends, cuts.mask)
        return SEAM * soft + (0.0 if self._is_quick else HARD_SEAM * hard)

    def _cost(self, islands):
        if self._is_quick:
            return islands.cost - HARD_SEAM * islands.hard_length - of_direction(islands.quality)
        return islands.cost

    def _guess(self, candidate):
        """About what it costs when squares are evened, and what overlaps is cut apart."""
        islands = candidate.islands
        squares = _squares(islands)
        if not math.isfinite(squares):
            return math.inf
        left = EVENED if self._evenness > 0 else 1.0
        return self._cost(islands) - (1 - left) * squares - max(islands.overlap_cost - PARTED, 0.0)

    def _as_given(self, found):
        """With corners as they were given, where polygons were turned round."""
        if self._surface is self.surface:
            return found
        uv = np.empty_like(found.uv)
        uv[self._order] = found.uv
        quality, kept = found.quality, ("overlapping_part", "unseen_angle")
        of_corners = {name: getattr(quality, name) for name in kept}
        quality = replace(Quality.of(self.surface._native, uv, self._threads), **of_corners)
        if self._is_upright:
            quality = quality.upright(uv, self.surface.up)
        return replace(found, uv=arrays.frozen(uv), quality=quality)


def _squares(islands):
    """What is minded of the squares."""
    return of_squares(islands.quality) - islands.overlap_cost
