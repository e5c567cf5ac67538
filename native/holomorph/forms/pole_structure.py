"""Surfaces with poles: differentials with residues, log maps, the map to the sphere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..core import arrays
from ..core.array_types import Complexes, Integers, Progress, Reals
from ..core.value import plain
from .form_structure import FormStructure


@dataclass(frozen=True, eq=False, repr=False)
class PoleStructure(FormStructure):
    """Result of `log_map`: a surface of genus g with poles p_i.

    The first form, theta_0, is a differential of the third kind: around p_i the UVs change by the residue r_i (that is,
    theta_0 has the residue r_i / (2 pi i) there); for real residues all its periods are real, so v is single-valued.
    Every face is kept: in the star of a pole, which lies at infinity, each triangle has an apex of its own, placed
    by the similarity that fits its outer side.

    The holomorphic forms of the surface come after theta_0: g on a closed surface, where the residues sum to 0, and
    2g + b - 1 with b boundary loops. There, for real residues and coefficients, v is constant along each loop, which
    becomes a straight line.

    All of it belongs to the surface's own triangles; in a polygon at a pole the diagonals are flipped away from it.
    """

    map_kind = "log"

    @cached_property
    def description(self) -> str:
        """What was made, in one phrase."""
        names = [str(p) for p in self.poles]
        ends = f"poles at {', '.join(names[:-1])} and {names[-1]}" if len(names) > 1 else f"a pole at {names[0]}"
        usual = [1, -1] if self._component.boundary_count == 0 else np.ones(len(names))
        if not np.array_equal(self.residues, usual):
            ends += f", residues {', '.join(_text(r) for r in self.residues)}"
        forms = self._differentials.shape[1] - 1
        more = "" if forms == 0 else f" and {forms} holomorphic form{'s' if forms > 1 else ''}"
        return f"{'differential' if self._component.genus else 'log map'}{more} with {ends}"

    @cached_property
    def poles(self) -> Integers:
        """(k,) vertices."""
        return self._of_surface(self._native.poles())

    @cached_property
    def residues(self) -> Complexes:
        """(k,) complex residues: by how much the UVs change around each pole, counter-clockwise."""
        return self._native.residues()

    def balanced_coefficients(self, progress: Progress | None = None) -> Complexes:
        """(n,) complex coefficients of theta_0 alone, which keeps its residues."""
        return arrays.frozen(np.eye(1, self._differentials.shape[1], dtype=np.complex128)[0])

    def sphere_map(self) -> Reals:
        """(#V, 3) points of the unit sphere: the conformal map of a surface of genus 0 with two poles, the first at
        (0, 0, 1), the second at (0, 0, -1), NaN at isolated vertices. Moebius maps along the axis are free: the mean
        height over the surface's area is 0.

        Raises TopologyError for another genus or number of poles."""
        return self._at_vertices(self._native.sphere_map())

    def invariants(self) -> dict[str, Any]:
        """The poles and their residues, as plain data: no other invariants are computed."""
        return plain({"poles": self.poles, "residues": self.residues})


def _text(residue):
    if residue.imag == 0:
        return f"{residue.real:g}"
    return f"{residue.real:g}{residue.imag:+g}i"
