"""Igusa's invariants from periods against those from the coefficients of curves."""

from math import prod

import families
import flat_cones
import numpy as np
import pytest
import sextics
from equivalence import random_symplectic
from holomorph import TopologyError, conformal_structure, igusa_invariants
from holomorph.igusa import invariants
from holomorph.siegel import moved, siegel_reduction
from solved import surface_of
from test_equivalence import BOLZA, LAWSON
from test_exact_values import complex_matrix, reference_surface, reference_values

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
    for ball, exact in zip(invariants(scrambled), sextics.absolute(curve), strict=True):
        assert abs(ball.value - float(exact)) <= ball.error < 1e-7 * abs(float(exact))


def test_all_vanish_where_the_first_does():
    assert not any(sextics.absolute(DECAGON_CURVE))
    omega = siegel_reduction(complex_matrix(reference_values()["genus2"]["decagon"])).period_matrix
    assert all(abs(ball.value) <= ball.error < 1e-9 for ball in invariants(omega))


@pytest.mark.parametrize(
    ("file", "curve"),
    [("omega2_squares4_level1.npz", BOLZA_CURVE), ("decagon_jittered_8.npz", DECAGON_CURVE)],
    ids=["Bolza", "decagon"],
)
def test_intervals_of_meshes_hold_the_curve_s_invariants(file, curve):
    found = igusa_invariants(conformal_structure(reference_surface(file), bounds=2e-3))
    exact = np.array([float(value) for value in sextics.absolute(curve)])
    assert (np.abs(found.values - exact) <= found.errors).all()
    assert (found.errors < np.maximum(np.abs(exact), 2) / 2).all()


def test_wide_bounds_leave_them_open():
    found = igusa_invariants(conformal_structure(surface_of(flat_cones.regular_polygon(10))))
    assert np.isinf(found.errors).all()


@pytest.mark.parametrize("mesh", [families.torus(12, 8), families.cylinder(8, 4)], ids=["torus", "cylinder"])
def test_other_surfaces_have_none(mesh):
    with pytest.raises(TopologyError, match="closed surfaces of genus 2"):
        igusa_invariants(conformal_structure(surface_of(mesh)))
