"""Igusa's invariants from periods against those from the coefficients of curves."""

from math import prod

import families
import flat_cones
import numpy as np
import pytest
import sextics
from curve_periods import curve_period_matrix
from equivalence import random_symplectic
from holomorph import TopologyError, conformal_structure, igusa_invariants
from holomorph.moduli.symplectic import invariants, moved, siegel_reduction
from known_matrices import BOLZA, LAWSON
from shared_data import complex_matrix, reference_values
from solved import surface_of

BOLZA_CURVE, LAWSON_CURVE, DECAGON_CURVE = [1, 0, 0, 0, -1, 0], [1, 0, 0, 0, 0, 0, -1], [1, 0, 0, 0, 0, -1]


def matching(six):
    """The ways to pair off these."""
    first, rest = six[0], six[1:]
    if not rest:
        return
    for other in rest:
        left = [x for x in rest if x != other]
        for pairs in matching(left) if left else [[]]:
            yield [(first, other), *pairs]


def test_the_oracle_follows_the_definition():
    """I2 of a sextic with roots: the sum of (12)^2 (34)^2 (56)^2 over the 15 ways to pair them; I10: discriminant."""
    roots = [0, 1, 2, 3, 5, 11]
    coefficients = [int(c) for c in np.rint(np.poly(roots))]
    I2, *_, I10 = sextics.igusa_clebsch(coefficients)
    assert sum(prod((a - b) ** 2 for a, b in pairs) for pairs in matching(roots)) == I2
    assert prod((a - b) ** 2 for i, a in enumerate(roots) for b in roots[:i]) == I10


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("omega", "curve"), [(BOLZA, BOLZA_CURVE), (LAWSON, LAWSON_CURVE)], ids=["Bolza", "Lawson"])
def test_exact_periods_have_the_curve_s_invariants(omega, curve, seed):
    scrambled = siegel_reduction(moved(omega, random_symplectic(2, seed, steps=3))).period_matrix
    assert invariants(scrambled) == pytest.approx([float(value) for value in sextics.absolute(curve)], rel=1e-7)


def test_all_vanish_where_the_first_does():
    assert not any(sextics.absolute(DECAGON_CURVE))
    omega = siegel_reduction(complex_matrix(reference_values()["genus2"]["decagon"])).period_matrix
    assert np.abs(invariants(omega)).max() < 1e-9


def test_those_of_narrow_bounds_are_the_curve_s():
    structure = conformal_structure(surface_of(flat_cones.regular_polygon(8)), bounds=1e-6)
    exact = np.array([float(value) for value in sextics.absolute(BOLZA_CURVE)])
    assert igusa_invariants(structure) == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize("mesh", [families.torus(12, 8), families.cylinder(8, 4)], ids=["torus", "cylinder"])
def test_other_surfaces_have_none(mesh):
    with pytest.raises(TopologyError, match="closed surface of genus 2"):
        igusa_invariants(conformal_structure(surface_of(mesh)))


@pytest.mark.parametrize("seed", range(4))
def test_igusa_s_invariants_are_those_of_the_coefficients(seed):
    coefficients = [2, *(int(c) for c in np.random.default_rng(seed).integers(-5, 6, 5)), 1]
    omega = siegel_reduction(curve_period_matrix(coefficients)).period_matrix
    exact = [float(value) for value in sextics.absolute(coefficients)]
    assert invariants(omega) == pytest.approx(exact, rel=1e-8, abs=1e-8)
