"""The map of a part in pieces between its hard edges, some of them with whole tiles; or cut open where few see it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .. import _native
from ..core import arrays
from ..core.array_types import Integers, Progress
from ..core.progress import scaled
from ..core.value import counted
from ..cutting.island_layout import Islands
from ..cutting.island_map import HARD, SMOOTH
from ..mesh.edges import boundary_edges, edge_keys
from ..mesh.hard_edges import breaks
from ..mesh.origin import edges_on_part
from ..mesh.surface import Surface
from ..quality.appearance import HARD_SEAM, TURN
from ..quality.quality import Quality
from .arrangement import arranged, unit_length
from .automatic_structure import AnyStructure, automatic_structure
from .budget import Budget
from .map import Map
from .mixed import Mixed
from .pieces import REST, Piece, closed, cut_apart, cut_in_hiding, is_tube, names_of_pieces, opened, smooth_pieces
from .request import Request
from .size import TRIES, Window, is_in, nearest, relative_size, window_around
from .tiling_search import REFUSALS, TilingSearch
from .untiled import FLAT, Untiled

EXACT = (1.0, 1.0)  # the window of the wanted density alone
UNEVEN = 2.2  # density ratio of a tiling, from which on it may be better to cut the part open


@dataclass(frozen=True)
class _Division:
    """names : (#F,) the piece of each polygon; pieces : those that may get a tiling, the largest first; cut : how far a
    cut is seen that divides nothing, None along hard edges"""

    names: Integers
    pieces: tuple[tuple[Piece, TilingSearch], ...]
    cut: float | None = None


@dataclass(frozen=True, eq=False)
class _Tiled:
    """A piece with its tiling. is_tube : but for windows"""

    piece: Piece
    map: Map
    is_tube: bool

    @cached_property
    def turn(self):
        """The cost of rows that turn in its islands; 0 where poles turn them in the tiling, too."""
        return TURN * self.piece.turn(self.map.uv) if self.is_tube and not len(self.map.poles) else 0.0


class PieceSearch:
    """The maps of a part in pieces, by each angle between faces that divides it in another way.

    structure : of the part
    flat : its islands, if there are any: only where these have a seam across the smooth or stretch a tiling is tried
    """

    def __init__(
        self,
        request: Request,
        structure: AnyStructure,
        flat: Islands | None,
        budget: Budget,
        threads: int | None = None,
    ) -> None:
        self._request, self._surface, self._structure = request, request.surface, structure
        self._flat, self._budget, self._threads = flat, budget, threads
        self._found: list[_Division] | None = None
        self._cut: list[_Division] | None = None
        self._rest: dict[bytes, Map] = {}

    def best(
        self, rival: Map | None, density: float, tries: int, window: Window, progress: Progress | None
    ) -> Map | None:
        """The map of least cost, if it is below that of another one, to which that of rows that turn is added.

        tries : numbers of tiles for the largest piece, whose density is then that of the others; 0 where it is given
        window : of pieces' densities over the one that is wanted
        """
        if self._found is None:
            self._found = list(self._divisions(scaled(progress, 0.0, 0.0)))
        if self._cut is None and self._may_be_cut(rival):
            self._cut = list(self._in_hiding(scaled(progress, 0.0, 0.0)))
        divisions = self._found + (self._cut or [])
        best, least, count = None, math.inf, len(divisions)
        for n, division in enumerate(divisions):
            worth = [pair for pair in division.pieces if self._is_worth(*pair, rival)]
            tiled = self._tiled(worth, density, tries, window, scaled(progress, n / count, (n + 1) / count))
            most = math.inf if rival is None else rival.cost + (self._turns(tiled) if rival.islands else 0.0)
            made, minded = self._least_minded(division, tiled, scaled(progress, (n + 1) / count, (n + 1) / count))
            if made and minded < min(most, least):
                best, least = made, minded
            if made and made.cost - HARD_SEAM * made.mixed.hard_length <= FLAT:
                break
            if best and n + 1 < count and not self._budget.goes_on():
                break
        return best

    def _divisions(self, progress) -> Iterator[_Division]:
        """By each angle that divides the part in another way."""
        bent, known = breaks(self._surface), None
        for degrees in (angle for angle in HARD if angle > SMOOTH):
            names = names_of_pieces(self._surface, bent > math.radians(degrees))
            if names.max() == names.min() or np.array_equal(names, known):
                continue
            known = names
            pieces = smooth_pieces(self._surface, self._flat, names, self._threads or 0)
            solved = tuple((piece, self._search(piece, progress)) for piece in pieces)
            solved = tuple((piece, search) for piece, search in solved if search)
            if solved:
                yield _Division(names, solved)

    def _may_be_cut(self, rival):
        """Whether squares differ so much that another tiling is made of the part cut open. Only those that turn gain by
        that: others had more poles on it."""
        is_uneven = rival is not None and bool(rival.tiling) and rival.quality.density_ratio > UNEVEN
        return is_uneven and self._request.main == "automatic" and self._request.options.get("turns", 1) != 1

    def _in_hiding(self, progress) -> Iterator[_Division]:
        """The part cut open, if it does not fall apart and can be solved."""
        found = cut_in_hiding(self._surface, self._request.is_upright, self._threads or 0, progress)
        search = found and self._search(found[0], progress, lines="none")
        if search:
            names = np.zeros(len(self._surface.face_offsets) - 1, np.int64)
            yield _Division(names, ((found[0], search),), found[1])

    def _search(self, piece, progress, **own):
        """None for a piece on which nothing can be solved: it becomes an island. own : options for it"""
        try:
            surface = closed(piece.surface) if not own else piece.surface
            structure = automatic_structure(surface, threads=self._threads, progress=progress)
        except REFUSALS:
            return None
        marked = self._request.options.get("marked")
        own = own if marked is None else own | {"marked": edges_on_part(surface, marked)}
        return TilingSearch(
            surface, structure, replace(self._request, options={**self._request.options, **own}), self._budget
        )

    def _is_worth(self, piece, search, rival):
        """Whether its tiling may be part of a map that costs less than a tiling of the whole part. On a tube one
        without poles tells that: they would turn the rows that run around it."""
        if not (rival and rival.tiling and is_tube(search.surface)):
            return True
        return search.guess_without_poles() * piece.surface.area < rival.cost * self._surface.area

    def _tiled(self, pieces, density, tries, window, progress):
        """The `_Tiled` pieces that may be better than islands."""
        made, count = [], len(pieces)
        for n, (piece, search) in enumerate(pieces):
            step, leads = scaled(progress, n / count, (n + 1) / count), tries > 0 and not made
            tiling = self._of_density(search, density, tries if leads else 0, window, step)
            if tiling is None:
                continue
            one = _Tiled(piece, opened(tiling, piece.surface), is_tube(search.surface))
            if one.map.cost < piece.cost + one.turn:
                density = one.map.density if leads else density
                made.append(one)
        return made

    def _of_density(self, search, density, tries, window, progress):
        """A tiling with any density, by some tries, or with one in the window, if need be stretched; None without."""
        try:
            tilings = search.of_density(density, tries or (1 if is_tube(search.surface) else TRIES), progress)
        except REFUSALS:
            return None
        made = nearest(tilings, density)
        if tries or is_in(window, relative_size(made, density)):
            return made
        stretched = search.stretched(made, density)
        return stretched or (made if is_in(window_around(), relative_size(made, density)) else None)

    def _least_minded(self, division, tiled, progress):
        """(The map in pieces, or None; its cost with that of rows that turn in its islands)"""
        choices = [tiled, [one for one in tiled if one.map.cost < one.piece.cost]]
        best, least = None, math.inf
        for kept in choices[: 1 + (len(choices[1]) < len(tiled))]:
            found = self._glued(division, kept, progress) if kept else None
            minded = found.cost + self._turns(one for one in tiled if one not in kept) if found else math.inf
            if minded < least:
                best, least = found, minded
        return best, least

    def _glued(self, division, tiled, progress):
        """The map with these tilings; None where the rest has none."""
        names = np.where(np.isin(division.names, [one.piece.name for one in tiled]), division.names, REST)
        try:
            parts = [one for one in cut_apart(self._surface, names) if names[one.face_index[0]] == REST]
            rest = [self._untiled(one, progress) for one in parts]
        except REFUSALS:
            return None
        maps = [one.map for one in tiled] + rest
        return mixed_map(self._surface, self._structure, maps, self._request.evenness, division.cut)

    def _untiled(self, piece, progress):
        """The map of a piece without tiling. Several divisions have the same pieces."""
        key = piece.face_index.tobytes()
        if key not in self._rest:
            structure = automatic_structure(piece, threads=self._threads, progress=progress)
            untiled = Untiled(piece, structure, self._request.evenness, self._request.is_upright, self._threads)
            self._rest[key] = untiled.best("it has no tiling", progress)
        return self._rest[key]

    def _turns(self, tiled):
        """The cost of rows that turn, for the whole part, if these pieces are islands."""
        return sum(one.turn * one.piece.surface.area for one in tiled) / self._surface.area


def mixed_map(
    surface: Surface, structure: AnyStructure, pieces: Sequence[Map], evenness: float, cut: float | None = None
) -> Map:
    """The `Map` of a connected part from those of its pieces, of which one at least is a tiling.

    pieces : of `cut_apart`, whose surfaces count vertices and corners as the part does
    cut : how far the seams are seen, over the square root of the area; None along hard edges
    """
    tiled, unit = [made for made in pieces if made.tiling], unit_length(pieces)
    quality = Quality.joined([m.quality for m in pieces], [m.density if m.tiling else unit**-2 for m in pieces])
    uv = arrays.frozen(arranged(pieces, len(surface.corner_vertices)))
    tilings = tuple(_of_part(made.tiling, made.surface.vertex_index) for made in tiled)
    is_border, seams = _seams(surface, pieces)
    mixed = Mixed(uv, tilings, seams, quality, evenness, *_seen_lengths(surface, is_border, cut))
    if cut is not None:
        why = f"cut open where it is hardly seen it has whole tiles: size range {quality.size_range:.3g}"
        return Map(surface, structure, uv, quality, np.empty(0), why, mixed=mixed)
    has = f"{counted(len(tiled), 'piece')} between hard edges {'has' if len(tiled) == 1 else 'have'} whole tiles"
    rest = ", the rest flattens" if len(tiled) < len(pieces) else ""
    why = f"{has}{rest}: size range {quality.size_range:.3g}"
    return Map(surface, structure, uv, quality, np.empty(0), why, mixed=mixed)


def _of_part(tiling, vertex_index):
    zeros, orders = tiling.zeros
    own = tiling.poles, zeros, tiling.seams, tiling.cones
    poles, zeros, seams, cones = (arrays.frozen(vertex_index[each]) for each in own)
    return replace(tiling, poles=poles, zeros=(zeros, orders), seams=seams, cones=cones)


def _seams(surface, pieces):
    """((#E,) whether a texture breaks off at an edge, (#S, 2) vertices of the edges where the UVs jump)."""
    edges, count = np.asarray(surface._native.edges), len(surface.vertices)
    keys = edge_keys(edges, count)
    is_inner = np.bincount(surface._native.triangle_edges.ravel(), minlength=len(edges)) == 2

    def are(ends):
        return is_inner & np.isin(keys, np.concatenate([edge_keys(own, count) for own in ends]))

    borders = [made.surface.vertex_index[boundary_edges(made.surface)] for made in pieces]
    own = [(made.surface.vertex_index[made.seams], bool(made.tiling)) for made in pieces]
    is_border = are(borders + [ends for ends, is_tiling in own if not is_tiling])
    return is_border, arrays.frozen(edges[is_border | are([ends for ends, _ in own])])


def _seen_lengths(surface, is_border, cut):
    """(length of seams across the smooth, or what is seen of a `cut`, and of hidden ones) over the root of the area."""
    lengths, part = surface._native.edge_lengths[is_border], _native.seen(breaks(surface)[is_border])
    size = math.sqrt(surface.area)
    soft = float((lengths * part).sum()) / size if cut is None else cut
    return soft, float(lengths.sum()) / size - soft
