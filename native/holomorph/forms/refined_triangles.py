"""Refinement of intrinsic triangulations, triangles with lengths and closed integer forms: edges are halved, or corners
cut off at some vertices, there where the two-sided bounds lose most."""

from dataclasses import dataclass, fields

import numpy as np

UNIT = 2.0**-53
# Rounding of a distance d, d^2 a sum of three multiples of squared sides, in parts of the sum of their sizes over d:
# 4 units of d^2 make 2, and 1 of the root makes no more.
OF_DISTANCE = 3 * UNIT
CUT = 1 / 4  # part of each side that a corner has when it is cut off: a power of 2, so that layers are similar exactly


@dataclass(frozen=True)
class Triangles:
    """A triangulation by its sides, side i of a triangle from its corner i to its corner i + 1.

    corners, edges : (#T, 3) vertices, and names of the edges
    lengths : (#E,); errors : (#T,) by what part the energy of a form on a triangle may be larger on the surface that
    this one stands for
    classes : (#T, 3, m) values of m closed integer forms along the sides
    """

    corners: np.ndarray
    edges: np.ndarray
    lengths: np.ndarray
    errors: np.ndarray
    classes: np.ndarray

    @property
    def sides(self):
        """(#T, 3) lengths."""
        return self.lengths[self.edges]

    @classmethod
    def of(cls, parts):
        """Joins pieces, whose edges are known by their names."""
        whole = _Pieces(*(np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(_Pieces)))
        _, first, edges = np.unique(whole.names, return_index=True, return_inverse=True)
        return cls(whole.corners, edges.reshape(-1, 3), whole.sides.ravel()[first], whole.errors, whole.classes)


def areas(sides):
    """(#T,) by Heron's formula in Kahan's order."""
    c, b, a = np.moveaxis(np.sort(sides, axis=1), 1, 0)
    return np.sqrt(np.maximum((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)), 0)) / 4


def corner_angles(sides):
    """(#T, 3) angles at the corners of triangles with these sides."""
    before, opposite = np.roll(sides, 1, axis=1), np.roll(sides, -1, axis=1)
    return np.arctan2(4 * areas(sides)[:, None], sides**2 + (before - opposite) * (before + opposite))


def worst(gap, part):
    """(#T,) bool: as few triangles as have this part of all gaps (Doerfler 1996, doi:10.1137/0733054)."""
    order = np.argsort(-gap, kind="stable")
    total = np.cumsum(gap[order])
    marked = np.zeros(len(gap), dtype=bool)
    marked[order[: 1 + np.searchsorted(total, part * total[-1])]] = True
    return marked


def halved(triangles, marked):
    """`Triangles` in which all sides of the marked ones are halved.

    Their neighbours are cut as far as these midpoints ask for it: into two, three or four. The surface remains the
    same, but for the rounding of medians, which `errors` hold; halves are exact."""
    is_cut = np.zeros(len(triangles.lengths), dtype=bool)
    is_cut[triangles.edges[marked]] = True
    return _cut(triangles, np.stack([is_cut, np.zeros_like(is_cut)], axis=1), is_cut[triangles.edges], HALVES)


def with_layers(triangles, layers):
    """`Triangles` in which the corners at vertex v are cut off layers[v] times, each time `CUT` as large: similar
    triangles, smaller and smaller towards v, as functions like r^a ask for. The surface remains the same, but for the
    rounding of other sides, which `errors` hold."""
    while layers.any():
        is_marked = layers > 0
        corners = is_marked[triangles.corners]
        is_cut = np.zeros((len(triangles.lengths), 2), dtype=bool)
        along = _runs_along(triangles.edges)
        for ends in (corners, np.roll(corners, -1, axis=1)):
            is_cut[triangles.edges, np.where(along, 0, 1)] = ends
            along = ~along
        triangles = _cut(triangles, is_cut, corners, CORNERS)
        layers = np.concatenate([np.maximum(layers - 1, 0), np.zeros(is_cut.sum(), layers.dtype)])
    return triangles


def _turned(pattern, turns):
    """The pattern of a triangle whose corner 0 is called `turns`: corners are 0 to 2, points 3 i + k on side i."""
    return [tuple((x + turns) % 3 if x < 3 else (x - 3 + 3 * turns) % 9 + 3 for x in piece) for piece in pattern]


def _patterns(whole, one, two, three):
    """{(bool, bool, bool): pieces} by which of the three are cut; `one` and `two` cut the first ones."""
    patterns = {(False,) * 3: whole, (True,) * 3: three}
    for turns in range(3):
        for count, pattern in ((1, one), (2, two)):
            patterns[tuple((i - turns) % 3 < count for i in range(3))] = _turned(pattern, turns)
    return patterns


# Points: corners 0, 1, 2; on side i, from corner i to corner i + 1, 3 + 3 i is near corner i, 4 + 3 i near corner
# i + 1, 5 + 3 i the midpoint. Pieces by their corners.
WHOLE = [(0, 1, 2)]
HALVES = _patterns(
    WHOLE,
    [(0, 5, 2), (5, 1, 2)],
    [(5, 1, 8), (8, 2, 0), (0, 5, 8)],
    [(0, 5, 11), (1, 8, 5), (2, 11, 8), (5, 8, 11)],
)
CORNERS = _patterns(
    WHOLE,
    [(0, 3, 10), (3, 1, 2), (10, 3, 2)],
    [(0, 3, 10), (1, 6, 4), (10, 3, 2), (3, 4, 2), (4, 6, 2)],
    [(0, 3, 10), (1, 6, 4), (2, 9, 7), (10, 3, 4), (4, 6, 7), (7, 9, 10), (4, 7, 10)],
)
_E = np.eye(3)
PLACES = np.concatenate(  # of all points, in barycentric coordinates
    [_E, *([_E[i] + part * (_E[(i + 1) % 3] - _E[i]) for part in (CUT, 1 - CUT, 0.5)] for i in range(3))]
)


def _cut(triangles, is_cut, which, patterns):
    """`Triangles` cut by patterns: `which`, (#T, 3), are sides or corners that are; `is_cut`, (#E, 2), whether an edge
    is near its start, or in the middle, and near its end."""
    cut = _Cut(triangles, is_cut)
    parts = []
    for marked, pieces in patterns.items():
        t = np.flatnonzero((which == marked).all(axis=1))
        parts += [cut.piece(t, piece) for piece in pieces]
    return Triangles.of(parts)


@dataclass(frozen=True)
class _Pieces:
    """Triangles with names of edges and lengths per side, (#T, 3)."""

    corners: np.ndarray
    names: np.ndarray
    sides: np.ndarray
    errors: np.ndarray
    classes: np.ndarray


class _Cut:
    """Pieces of `triangles`. New points are numbered behind the vertices; an edge has three names for its parts, and
    edges inside triangles are named behind them."""

    def __init__(self, triangles, is_cut):
        self.t = triangles
        self.along = _runs_along(triangles.edges)
        first = int(triangles.corners.max()) + 1
        self.points = first - 1 + np.cumsum(is_cut).reshape(-1, 2)
        self.inner = 3 * len(triangles.lengths)

    def vertex(self, t, point):
        """Its number, and the corner whose potential it has: that of the end of the edge that it is near to; a midpoint
        has that of the start."""
        if point < 3:
            return self.t.corners[t, point], np.full(len(t), point)
        side, place = divmod(point - 3, 3)
        at_end = np.zeros(len(t), bool) if place == 2 else self.along[t, side] == (place == 1)
        corner = np.where(at_end == self.along[t, side], (side + 1) % 3, side)
        return self.points[self.t.edges[t, side], at_end.astype(int)], corner

    def potential(self, t, corner):
        """What the classes have integrated to from corner 0 on."""
        first, last = self.t.classes[t, 0], -self.t.classes[t, 2]
        return np.where((corner == 1)[:, None], first, np.where((corner == 2)[:, None], last, 0))

    def name(self, t, start, end):
        side = _side_of(start, end)
        if side is None:
            return self.inner + len(PLACES) ** 2 * t + min(start, end) * len(PLACES) + max(start, end)
        # Part 1 of an edge is at its start, part 2 at its end, the whole or the middle is 0.
        touches = side in (start, end), (side + 1) % 3 in (start, end)
        if touches[0] == touches[1]:
            return 3 * self.t.edges[t, side]
        return 3 * self.t.edges[t, side] + np.where(self.along[t, side] == touches[0], 1, 2)

    def length(self, t, start, end):
        """The distance of two points, and by how much it may be wrong."""
        d = PLACES[end] - PLACES[start]
        if (d == 0).any():  # parallel to a side
            i = (int(np.flatnonzero(d == 0)[0]) + 1) % 3
            length = np.abs(d[i]) * self.t.lengths[self.t.edges[t, i]]
            is_exact = np.frexp(d[i])[0] in (-0.5, 0.5)
            return length, np.zeros(len(t)) if is_exact else UNIT * length
        terms = -d * np.roll(d, -1) * self.t.lengths[self.t.edges[t]] ** 2
        length = np.sqrt(np.maximum(terms.sum(axis=1), 0))
        with np.errstate(divide="ignore", invalid="ignore"):
            return length, OF_DISTANCE * np.abs(terms).sum(axis=1) / length

    def piece(self, t, points):
        """`_Pieces`: of each triangle t the one with these points as corners."""
        ends = list(zip(points, np.roll(points, -1), strict=True))
        vertices, corners = zip(*(self.vertex(t, point) for point in points), strict=True)
        potentials = [self.potential(t, corner) for corner in corners]
        lengths, missed = (np.stack(x, axis=1) for x in zip(*(self.length(t, *end) for end in ends), strict=True))
        growth = _growth(lengths, missed)
        errors = self.t.errors[t]
        return _Pieces(
            np.stack(vertices, axis=1),
            np.stack([self.name(t, *end) for end in ends], axis=1),
            lengths,
            np.minimum(errors + growth + errors * growth, 1),
            np.stack([potentials[(k + 1) % 3] - potentials[k] for k in range(3)], axis=1),
        )


def _side_of(start, end):
    """The side that both points are on, or None."""
    off = (PLACES[start] == 0) & (PLACES[end] == 0)
    return (int(np.flatnonzero(off)[0]) + 1) % 3 if off.any() else None


def _runs_along(edges):
    """(#T, 3) whether a side runs along its edge: the first one does. Ends cannot tell, for they may be the same."""
    along = np.zeros(edges.size, dtype=bool)
    along[np.unique(edges, return_index=True)[1]] = True
    return along.reshape(-1, 3)


def _growth(sides, missed):
    """(#T,) by what part energies on triangles may grow because their sides are wrong by as much as `missed`; 1 where
    that leaves them open. As mesh::energy_growth in the native core."""
    others = np.roll(sides, 1, axis=1) * np.roll(sides, -1, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        change = ((2 * sides + missed) * missed * others).sum(axis=1) / (4 * areas(sides) ** 2)
        return np.where(change < 0.5, change * (1 + change), 1)
