"""A period matrix in place of a surface, and what is compared of both."""

from __future__ import annotations

import numpy as np

from .. import _native
from ..core import arrays
from ..core.array_types import Complexes
from ..forms.bounded import BoundedStructure
from ..forms.period_matrix import checked_period_matrix, distance_within
from ..forms.results import Structure
from ..mesh.checks import only_component
from ..mesh.surface import Surface


class KnownPeriods:
    """The closed surfaces with a period matrix. It is as exact as its `error` says, at most to rounding; one without is
    as symmetric as it is exact."""

    boundary_count = 0

    def __init__(self, period_matrix):
        omega = checked_period_matrix(period_matrix)
        unit = np.finfo(float).eps / 2
        change = np.abs(np.asarray(period_matrix) - omega) + 2 * len(omega) * unit * np.abs(omega)
        self.period_matrix: Complexes = arrays.frozen(omega)
        self.error = getattr(period_matrix, "error", 0.0) + distance_within(omega, change)
        # Half a unit in the last place of each entry, and the error of a distance that is measured.
        self.rounding = distance_within(omega, unit * np.abs(omega)) + len(omega) * unit
        self.is_exact = self.error <= 2 * len(omega) * self.rounding
        self.genus = len(omega)
        widths = np.exp([-self.error, self.error])
        self.period_bounds = widths[0] * omega.imag, widths[1] * omega.imag
        self._topology = _native.TopologicalType(self.genus, 0)

    def lattice(self):
        """The lattice in the classes dual to the canonical basis; the first g are dual to the a_i."""
        real, imaginary = self.period_matrix.real, self.period_matrix.imag
        inverse = np.linalg.inv(imaginary)
        gram = np.block([[imaginary + real @ inverse @ real, -real @ inverse], [-inverse @ real, inverse]])
        one, none = np.eye(self.genus, dtype=np.int64), np.zeros((self.genus, self.genus), np.int64)
        upper = np.exp(self.error) * (gram + gram.T) / 2
        return _native.PeriodLattice.closed(upper, np.block([[none, one], [-one, none]]))


def period_lattice(structure):
    """The native lattice of integer classes with their energies: of a closed structure, of one with boundary, of
    `KnownPeriods`."""
    if isinstance(structure, KnownPeriods):
        return structure.lattice()
    gram = structure._native.certain_gram_matrices()
    if isinstance(structure, BoundedStructure):
        return _native.PeriodLattice.bounded(*gram, structure.pairing, structure._component.genus)
    wedge = -np.rint(np.linalg.inv(structure.intersection_matrix)).astype(np.int64)
    return _native.PeriodLattice.closed(gram[0], wedge)


def side_of(given):
    """The connected surface, or `KnownPeriods`, of what is to be compared."""
    if isinstance(given, (Surface, Structure)):
        return only_component(given.surface if isinstance(given, Structure) else given)
    try:
        is_numeric = np.asarray(given).dtype.kind in "iufc"
    except ValueError:  # rows of different lengths
        is_numeric = False
    if not is_numeric:
        raise TypeError(f"surfaces, structures or period matrices are compared, not {type(given).__name__}")
    return KnownPeriods(given)
