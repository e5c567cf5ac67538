"""The symmetries of a surface, as far as its periods tell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import _native
from .._native import Error
from ..core.array_types import Integers, Progress
from ..core.value import Value, counted
from ..forms.structure import ConformalStructure
from ..mesh.checks import real_number
from .equivalence import AGREEMENT, ROUNDING, STEPS, period_lattice

GAP = 1e-6  # part of what is allowed: residuals that differ by less belong to the same symmetry of the mesh


@dataclass(frozen=True, eq=False, repr=False)
class Automorphisms(Value):
    """What `automorphisms` found.

    order : number of integer matrices that keep the wedge product and the energies, for genus >= 2 the conformal maps
        of the surface to itself where it is hyperelliptic, twice as many where it is not (Torelli: -1 comes from a map
        on hyperelliptic surfaces alone); for genus 1 those that fix a point
    generators : tuple of (2g, 2g) integers in the classes dual to `homology_basis`, as `Equivalence.matrix`
    tolerance : the largest residual of the group's matrices, as `Equivalence.residual`: the surface is that near to one
        with these symmetries
    at_most : number of matrices that the bounds of the periods do not exclude: the order of the surface's own group is
        certainly not larger. None where the search for them reached its limit
    """

    order: int
    generators: tuple[Integers, ...]
    tolerance: float
    at_most: int | None

    def _facts(self):
        return [f"order {self.order}", counted(len(self.generators), "generator"), f"tolerance {self.tolerance:.2g}"]


def automorphisms(
    structure: ConformalStructure, *, tolerance: float = 0.0, progress: Progress | None = None
) -> Automorphisms:
    """The `Automorphisms` of a closed structure: the largest group of integer matrices that bring the projected periods
    to themselves within a quarter of their bounds, or `tolerance` if that is larger.

    tolerance : `Equivalence.residual` that counts as none: a mesh of a symmetric surface need not be symmetric itself

    Raises TypeError for another kind of structure; Error where the search reaches its limit; Cancelled.

    Cost: grows with the number of matrices that the bounds allow.
    Source: Plesken & Souvignier (1997), as in `conformally_equivalent`.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> structure = holomorph.conformal_structure(surface)
    >>> print(holomorph.automorphisms(structure).order)
    4
    """
    if not isinstance(structure, ConformalStructure):
        raise TypeError(f"automorphisms need the structure of a closed surface, not a {type(structure).__name__}")
    lattice = period_lattice(structure)
    allowed = max(real_number(tolerance, "tolerance"), AGREEMENT * lattice.radius(), ROUNDING)
    projected = lattice.projected()
    found, is_complete = _native.isometries(projected, projected, sign=1, slack=allowed, progress=progress)
    if not is_complete:
        raise Error(f"the search among integer matrices reached its limit of {STEPS} steps")
    found = sorted(found, key=lambda isometry: isometry.residual)
    matrices, residuals = np.array([each.matrix for each in found]), np.array([each.residual for each in found])
    count, generators = _largest_group(matrices, residuals, allowed)
    others, is_complete = _native.isometries(lattice, lattice, sign=1, slack=0.0, progress=progress)
    at_most = len(others) if is_complete else None
    return Automorphisms(count, tuple(matrices[generators]), float(residuals[count - 1]), at_most)


def _largest_group(matrices, residuals, allowed):
    """(count, generators): of the matrices, nearest first, the number in the largest group, and the places of some that
    generate it. Residuals that are almost the same belong to the same symmetries."""
    ends = np.flatnonzero(np.diff(residuals, append=np.inf) > GAP * allowed) + 1
    for count in ends[::-1]:
        generators = _generators(matrices[:count])
        if generators is not None:
            return int(count), generators
    raise Error("the symmetries of the periods do not form a group")


def _generators(matrices):
    """Places of few matrices that generate all; None where these are no group. A finite set is one if it is closed
    under products with matrices whose products reach all of it."""
    places = {matrix.tobytes(): i for i, matrix in enumerate(matrices)}
    reached = np.zeros(len(matrices), bool)
    reached[places[np.eye(matrices.shape[1], dtype=matrices.dtype).tobytes()]] = True
    chosen, moves = [], []
    while not reached.all():
        chosen.append(int(np.argmin(reached)))
        products = np.ascontiguousarray(matrices @ matrices[chosen[-1]])
        moves.append(np.array([places.get(product.tobytes(), -1) for product in products]))
        if (moves[-1] < 0).any():
            return None
        before = 0
        while reached.sum() > before:
            before = reached.sum()
            for move in moves:
                reached[move[reached]] = True
    return chosen
