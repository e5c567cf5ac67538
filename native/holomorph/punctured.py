"""Surfaces with punctures: differentials with residues, log maps, the map to the sphere."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import _native, arrays
from .report import complex_pairs
from .results import Quality, Structure, checked_coefficients


@dataclass(frozen=True, eq=False)
class PuncturedStructure(Structure):
    """Result of `conformal_structure` for a surface of genus g with punctures p_i.

    The first form, theta_0, is a differential of the third kind: around p_i the UVs change by the residue r_i (that is,
    theta_0 has the residue r_i / (2 pi i) there); for real residues all its periods are real, so v is single-valued.
    Every face is kept: in the star of a puncture, which lies at infinity, each triangle has an apex of its own, placed
    by the similarity that fits its outer side.

    On a closed surface the residues sum to 0, and g holomorphic forms come after theta_0. With a boundary there is
    theta_0 alone, and for real residues v = 0 on the whole boundary: each loop is a straight line.

    All of it belongs to the artist's own triangles; in a polygon at a puncture the diagonals are turned away from it.
    """

    @property
    def description(self):
        """What was made, in one phrase."""
        names = [str(p) for p in self.punctures]
        ends = (
            f"punctures at {', '.join(names[:-1])} and {names[-1]}" if len(names) > 1 else f"a puncture at {names[0]}"
        )
        usual = [1, -1] if self._component.boundary_count == 0 else np.ones(len(names))
        if not np.array_equal(self.residues, usual):
            ends += f", residues {', '.join(_text(r) for r in self.residues)}"
        forms = self._form_count - 1
        more = "" if forms == 0 else f" and {forms} holomorphic form{'s' if forms > 1 else ''}"
        return f"{'differential' if self._component.genus else 'log map'}{more} with {ends}"

    @cached_property
    def punctures(self):
        """(k,) vertices."""
        return self._of_surface(self._native.punctures())

    @cached_property
    def residues(self):
        """(k,) complex residues: by how much the UVs change around each puncture, counter-clockwise."""
        return self._native.residues()

    @cached_property
    def edges(self):
        """(#E, 2) vertices of the triangulation, lower first, with the diagonals turned away from the punctures."""
        return self._of_surface(self._triangulation.edges)

    @cached_property
    def holomorphic_forms(self):
        """(1 + g, #E) complex, with a boundary (1, #E): theta_0, NaN on the edges that end at a puncture, and the g
        holomorphic forms."""
        return self._native.edge_values()

    @cached_property
    def _form_count(self):
        return self._native.form_count()

    @cached_property
    def _triangulation(self):
        return self._native.surface()

    def prepare_uv(self, progress=None):
        """Nothing is left to do: the forms are those of the artist's triangles."""

    @property
    def uv_solver(self):
        """The same as `solver`."""
        return self.solver

    def uv(self, coefficients):
        """(#C, 2) UVs of the form sum_j c_j theta_j, one complex coefficient c_j for each. No solve: one small product.

        Seams are the cut graph, which ends at the punctures, and the edges at the punctures. Across the former the UVs
        jump by a constant translation: with the coefficient 1 of theta_0 alone, on genus 0, by a residue."""
        return self._native.uv(checked_coefficients(coefficients, self._form_count, np.complex128))

    def balanced_coefficients(self):
        """(1 + g,), with a boundary (1,), complex coefficients of theta_0 alone: its residues stay as asked for."""
        return arrays.frozen(np.eye(1, self._form_count, dtype=np.complex128)[0])

    def quality(self, uv):
        """`Quality` of a (#C, 2) UV map on the triangles of `edges`."""
        return Quality(*_native.quality(self._triangulation, self._checked_uv(uv), 0))

    def averaged_star(self, form):
        """As for other results, on the triangles of `edges`."""
        return _native.averaged_star(self._triangulation, self._checked_form(form))

    def sphere_map(self):
        """(#V, 3) points of the unit sphere: the conformal map of a surface of genus 0 with two punctures, the first at
        (0, 0, 1), the second at (0, 0, -1), NaN at isolated vertices. Moebius maps along the axis are free: the mean
        height over the surface's area is 0.

        Raises TopologyError for another genus or number of punctures."""
        return self._at_vertices(self._native.sphere_map())

    def invariants(self):
        """The punctures and their residues, as plain data: positions of punctures carry no other invariant here."""
        return {"punctures": self.punctures.tolist(), "residues": complex_pairs(self.residues)}


def _text(residue):
    if residue.imag == 0:
        return f"{residue.real:g}"
    return f"{residue.real:g}{residue.imag:+g}i"
