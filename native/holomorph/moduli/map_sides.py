"""The two surfaces of a conformal map, with forms that correspond."""

from dataclasses import dataclass

import numpy as np

from .. import _native
from ..core.array_types import Integers, Reals
from ..forms.bounded import BoundedStructure
from ..mesh.double import double_cover
from ..mesh.surface import Surface


@dataclass(frozen=True, eq=False)
class Side:
    """surface : native triangulation; forms : (n, #E); starts : (k, 2) triangle and corner at which maps may begin;
    is_at_corner : whether they begin there exactly, as on a boundary, or in the triangle's middle; own_count : how many
    of its triangles, the first, are the surface's own: on a double the others are their reflections"""

    surface: _native.Surface
    forms: Reals
    starts: Integers
    is_at_corner: bool
    own_count: int

    @property
    def vertices(self):
        """(k,) of the starts."""
        return self.surface.triangles[self.starts[:, 0], self.starts[:, 1]]

    def residual(self, triangle, corner):
        """(n,) minus the integrals from the start to the middle of its triangle."""
        if not self.is_at_corner:
            return np.zeros(len(self.forms))
        along = _along_sides(self.surface, self.forms[:, self.surface.triangle_edges[[triangle]]], [triangle])[:, 0]
        return (along[:, corner - 1] - along[:, corner]) / 3


def sides(a, b, found):
    """Both sides of a map from structure `a` to `b`, whose classes correspond by the `Equivalence`. The boundary of `b`
    is no obstacle: its side is the double, whose first triangles are those of the surface."""
    if isinstance(a, BoundedStructure):
        return _bounded_sides(a, b, found)
    whiten = np.linalg.inv(np.linalg.cholesky(b._native.natural_gram()))
    forms = whiten @ found.matrix @ a.harmonic_forms, whiten @ b.harmonic_forms
    return tuple(_closed_side(structure, values) for structure, values in zip((a, b), forms))


def _closed_side(structure, forms):
    surface = structure._triangulation
    everywhere = np.stack([np.arange(len(surface.triangles)), np.zeros(len(surface.triangles), int)], axis=1)
    return Side(surface, forms, everywhere, is_at_corner=False, own_count=len(surface.triangles))


def _bounded_sides(a, b, found):
    """The forms are the Dirichlet ones and their conjugates, symmetric on the double, which a reflection reverses."""
    whiten = np.linalg.inv(np.linalg.cholesky(b.projected_gram_matrices[1]))
    sign = -1 if found.verdict == "mirror_image" else 1
    matrix = whiten @ found.matrix
    forms = np.concatenate([matrix @ a.dirichlet_forms, sign * matrix @ _conjugates(a)])
    first, second = (
        {"starts": _boundary_sides(side), "is_at_corner": True, "own_count": len(side.triangles)}
        for side in (a._triangulation, b._triangulation)
    )
    double = double_cover(Surface._of(b._triangulation))._native
    parts = [
        _on_double(b._triangulation, double, whiten @ values, parity)
        for values, parity in ((b.dirichlet_forms, -1), (_conjugates(b), 1))
    ]
    return Side(a._triangulation, forms, **first), Side(double, np.concatenate(parts), **second)


def _conjugates(structure):
    return -np.linalg.solve(structure.star, structure.natural_forms)


def _boundary_sides(surface):
    """(k, 2) triangle and side."""
    on_boundary = np.bincount(surface.triangle_edges.ravel(), minlength=len(surface.edges)) == 1
    return np.argwhere(on_boundary[surface.triangle_edges])


def _signs(surface, triangles=slice(None)):
    """+1 where a side runs along its edge: no edge is a loop."""
    corners = surface.triangles[triangles]
    return np.where(corners < np.roll(corners, -1, axis=1), 1, -1)


def _along_sides(surface, values, triangles=slice(None)):
    return values * _signs(surface, triangles)


def _on_double(surface, double, forms, parity):
    """(n, #E of the double): the same on dual edges, or the negative where `parity` is -1. Side 2 - k of a triangle in
    the second copy lies over side k, and runs backwards."""
    along = _along_sides(surface, forms[:, surface.triangle_edges])
    both = np.concatenate([along, -parity * along[:, :, ::-1]], axis=1)
    result = np.empty((len(forms), len(double.edges)))
    result[:, double.triangle_edges] = _along_sides(double, both)
    return result
