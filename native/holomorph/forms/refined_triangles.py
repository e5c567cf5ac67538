"""Nested refinement of intrinsic triangulations: triangles with lengths and closed integer forms are cut at midpoints
of edges, there where the two-sided bounds lose most."""

from dataclasses import dataclass, fields

import numpy as np

# Rounding of a median m, 4 m^2 = 2 (b^2 + c^2) - a^2, in parts of (a^2 + b^2 + c^2) / 2 m: 6 units of 4 m^2 make 1.5,
# and 1 of the root makes no more, for m^2 is below half of this sum.
OF_MEDIAN = 2.5 * 2.0**-53


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

    def values(self, functions):
        """(#T, 3, m) values of the forms eta + d f along the sides, f (#V, m)."""
        at_corners = functions[self.corners]
        return np.roll(at_corners, -1, axis=1) - at_corners + self.classes


def areas(sides):
    """(#T,) by Heron's formula in Kahan's order."""
    c, b, a = np.moveaxis(np.sort(sides, axis=1), 1, 0)
    return np.sqrt(np.maximum((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)), 0)) / 4


def gaps(triangles, functions, natural):
    """(#T,) numbers >= 0 whose sum is the trace of the relative width of the bounds, tr G^-1 (G - W G'^-1 W^T).

    That width is the energy of *h_i - sum_j C_ij h_j, with the C that makes it least, h_j of the other family on
    surfaces with boundary: it is a sum over triangles, and so tells where it comes from."""
    l0, l1, l2 = np.moveaxis(triangles.sides, 1, 0)
    area = areas(triangles.sides)
    x, y = (l0**2 + (l2 - l1) * (l2 + l1)) / (2 * l0), 2 * area / l0  # corner 2, with side 0 on the first axis
    h = triangles.values(functions)
    p = h[:, 0] / l0[:, None]
    q = (-h[:, 2] - p * x[:, None]) / y[:, None]
    forms = np.sqrt(area)[:, None, None] * np.stack([p, q], axis=1)  # (#T, 2, m), of unit metric
    own, other = forms[:, :, :natural], forms[:, :, natural:] if forms.shape[2] > natural else forms
    star = np.stack([-own[:, 1], own[:, 0]], axis=1)
    gram, other_gram = (np.einsum("tki,tkj->ij", part, part, optimize=True) for part in (own, other))
    products = np.einsum("tki,tkj->ij", star, other, optimize=True)
    rest = star - other @ np.linalg.solve(other_gram, products.T)
    orthonormal = np.linalg.solve(np.linalg.cholesky(gram), np.moveaxis(rest, 2, 0).reshape(natural, -1))
    return (orthonormal**2).sum(axis=0).reshape(-1, 2).sum(axis=1)


def worst(gap, part):
    """(#T,) bool: as few triangles as have this part of all gaps (Doerfler 1996, doi:10.1137/0733054)."""
    order = np.argsort(-gap, kind="stable")
    total = np.cumsum(gap[order])
    marked = np.zeros(len(gap), dtype=bool)
    marked[order[: 1 + np.searchsorted(total, part * total[-1])]] = True
    return marked


def refined(triangles, marked):
    """`Pieces` in which all sides of the marked triangles are halved.

    Their neighbours are cut as far as these midpoints ask for it: into two, three or four. The surface remains the
    same, but for the rounding of medians, which `errors` hold; halves are exact."""
    is_cut = np.zeros(len(triangles.lengths), dtype=bool)
    is_cut[triangles.edges[marked]] = True
    cut = _Cut(triangles, is_cut)
    count = is_cut[triangles.edges].sum(axis=1)
    return Pieces.of(
        [cut.whole(count == 0), *cut.in_two(count == 1), *cut.in_three(count == 2), *cut.in_four(count == 3)]
    )


@dataclass(frozen=True)
class Pieces:
    """The triangles that `Triangles` are cut into: names of edges and lengths are per side, (#T, 3)."""

    corners: np.ndarray
    names: np.ndarray
    sides: np.ndarray
    errors: np.ndarray
    classes: np.ndarray

    @classmethod
    def of(cls, parts):
        """Concatenates parts."""
        return cls(*(np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(cls)))


@dataclass(frozen=True, eq=False)
class _Sides:
    """Sides of some triangles: from and to which vertex, of which edge, how long, and the values of the classes."""

    start: np.ndarray
    end: np.ndarray
    name: np.ndarray
    length: np.ndarray
    classes: np.ndarray

    def reverse(self):
        return _Sides(self.end, self.start, self.name, self.length, -self.classes)


class _Cut:
    """The pieces of `triangles` whose edges are cut where `is_cut`. Midpoints, halves and edges inside triangles are
    numbered behind vertices and edges."""

    def __init__(self, triangles, is_cut):
        self.t = triangles
        vertex_count, edge_count = int(triangles.corners.max()) + 1, len(is_cut)
        self.midpoint = np.where(is_cut, vertex_count - 1 + np.cumsum(is_cut), -1)
        self.first_half = edge_count + 2 * np.cumsum(is_cut)
        self.first_inner = edge_count + 2 * (np.count_nonzero(is_cut) + 1)
        self.is_cut = is_cut
        # The first of an edge's sides runs along it: ends cannot tell, for they may be the same vertex.
        flat = triangles.edges.ravel()
        _, first = np.unique(flat, return_index=True)
        along = np.zeros(len(flat), dtype=bool)
        along[first] = True
        self.along = along.reshape(-1, 3)

    def turned(self, chosen):
        """The triangles with one or two sides cut: their numbers, and that of the cut side whose predecessor is not."""
        t = np.flatnonzero(chosen)
        cut = self.is_cut[self.t.edges[t]]
        return t, np.argmax(cut & ~np.roll(cut, 1, axis=1), axis=1)

    def side(self, t, i):
        i = i % 3
        edge = self.t.edges[t, i]
        corners = self.t.corners
        return _Sides(corners[t, i], corners[t, (i + 1) % 3], edge, self.t.lengths[edge], self.t.classes[t, i])

    def halves(self, t, i):
        """The two halves of a side. The midpoint has the potential of the end of the edge."""
        whole, along = self.side(t, i), self.along[t, i % 3]
        middle, half, name = self.midpoint[whole.name], whole.length / 2, self.first_half[whole.name]
        first = np.where(along[:, None], whole.classes, 0)
        return (
            _Sides(whole.start, middle, np.where(along, name, name + 1), half, first),
            _Sides(middle, whole.end, np.where(along, name + 1, name), half, whole.classes - first),
        )

    def third(self, t, which, first, second, length):
        """The side that closes a triangle behind two others, the inner edge number `which` of triangle t."""
        name = self.first_inner + 3 * t + which
        return _Sides(second.end, first.start, name, length, -(first.classes + second.classes))

    def median(self, t, i):
        """Length of the one that ends on side i."""
        a, b, c = (self.side(t, i + k).length for k in range(3))
        return np.sqrt(np.maximum(2 * (b**2 + c**2) - a**2, 0)) / 2

    def part(self, t, sides, median=None):
        """`Pieces` of triangles t with these three sides, of which `median` is rounded."""
        length = np.stack([side.length for side in sides], axis=1)
        errors = self.t.errors[t]
        if median is not None:
            growth = _growth(length, sides.index(median), self.t.sides[t])
            errors = np.minimum(errors + growth + errors * growth, 1)
        stacked = (np.stack([getattr(side, name) for side in sides], axis=1) for name in ("start", "name"))
        return Pieces(*stacked, length, errors, np.stack([side.classes for side in sides], axis=1))

    def whole(self, chosen):
        t = np.flatnonzero(chosen)
        return self.part(t, [self.side(t, i) for i in range(3)])

    def in_two(self, chosen):
        """Two triangles of a b c, with the midpoint m of a b."""
        t, i = self.turned(chosen)
        (am, mb), bc, ca = self.halves(t, i), self.side(t, i + 1), self.side(t, i + 2)
        mc = self.third(t, 0, ca, am, self.median(t, i))
        cm = mc.reverse()
        return [self.part(t, [ca, am, mc], mc), self.part(t, [mb, bc, cm], cm)]

    def in_three(self, chosen):
        """Three triangles of a b c, with the midpoints m of a b and n of b c."""
        t, i = self.turned(chosen)
        (am, mb), (bn, nc), ca = self.halves(t, i), self.halves(t, i + 1), self.side(t, i + 2)
        nm = self.third(t, 0, mb, bn, ca.length / 2)
        an = self.third(t, 1, nc, ca, self.median(t, i + 1))
        na, mn = an.reverse(), nm.reverse()
        return [self.part(t, [mb, bn, nm]), self.part(t, [nc, ca, an], an), self.part(t, [am, mn, na], na)]

    def in_four(self, chosen):
        """Four triangles: the inner one joins the midpoints of all sides."""
        t = np.flatnonzero(chosen)
        halves = [self.halves(t, i) for i in range(3)]
        inner = [self.third(t, i, halves[i - 1][1], halves[i][0], self.side(t, i + 1).length / 2) for i in range(3)]
        corners = [self.part(t, [halves[i - 1][1], halves[i][0], inner[i]]) for i in range(3)]
        return [*corners, self.part(t, [inner[i].reverse() for i in (0, 1, 2)])]


def _growth(sides, rounded, whole):
    """(#T,) by what part energies on triangles may grow because the side `rounded` of them is a rounded median of the
    triangles `whole`; 1 where rounding leaves that open. As mesh::energy_growth in the native core: for one side, the
    bound 1 / sqrt(1 - change) - 1 is little more than half of what is returned, so that its own rounding is covered."""
    length = sides[:, rounded]
    with np.errstate(divide="ignore", invalid="ignore"):
        error = OF_MEDIAN * (whole**2).sum(axis=1) / (2 * length)
        change = (2 * length + error) * error * sides[:, rounded - 1] * sides[:, rounded - 2] / (4 * areas(sides) ** 2)
        return np.where(change < 0.5, change * (1 + change), 1)
