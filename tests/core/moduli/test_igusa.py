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
from holomorph.moduli.igusa import enclosed, invariants
from holomorph.moduli.siegel import moved, siegel_reduction
from known_matrices import BOLZA, LAWSON
from shared_data import complex_matrix, reference_surface, reference_values
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
    omega = siegel_reduction(BOLZA).period_matrix
    assert np.isinf(enclosed(omega, 1.0)[1]).all()
    assert all(np.isinf(ball.error) for ball in invariants(omega, 1.5))


@pytest.mark.parametrize("radius", [1e-4, 1e-3, 1e-2])
@pytest.mark.parametrize("omega", [BOLZA, LAWSON], ids=["Bolza", "Lawson"])
def test_intervals_are_as_wide_as_the_bounds_allow(omega, radius):
    """No invariants of period matrices within a distance are outside, and the farthest are not far
    from the end. At symmetric curves, as these, the derivatives vanish: plain arithmetic is 100 times as wide."""
    omega = siegel_reduction(omega).period_matrix
    values, errors = enclosed(omega, radius)
    root, random = np.linalg.cholesky(omega.imag), np.random.default_rng(0)
    farthest = np.zeros(3)
    for _ in range(300):
        S = random.normal(size=(2, 2)) + 1j * random.normal(size=(2, 2))
        S = S + S.T
        u, _, v = np.linalg.svd(S)  # the nearest unitary one is symmetric: an end of the unit ball
        other = omega + np.expm1(radius) * root @ (u @ v) @ root.T
        found = np.array([ball.value for ball in invariants((other + other.T) / 2)])
        assert (np.abs(found - values) <= errors).all()
        farthest = np.maximum(farthest, np.abs(found - values))
    if radius < 1e-2:  # beyond, the remainder is not small
        assert (farthest > 0.3 * errors).all()


def test_they_are_narrowed_to_a_wished_width():
    structure = conformal_structure(surface_of(flat_cones.regular_polygon(8)))
    exact = np.array([float(value) for value in sextics.absolute(BOLZA_CURVE)])
    assert (igusa_invariants(structure).errors > 1e-3 * np.abs(exact)).all()
    found = igusa_invariants(structure, width=1e-3)
    assert found.refinement.reached
    assert (found.errors <= 1e-3 * np.abs(found.values)).all()
    assert (np.abs(found.values - exact) <= found.errors).all()


def test_what_keeps_them_wide_is_told():
    structure = conformal_structure(surface_of(flat_cones.regular_polygon(8)))
    found = igusa_invariants(structure, width=1e-6, most_faces=200)
    assert not found.refinement.reached and "more than 200" in found.refinement.reason
    with pytest.raises(ValueError, match="width is -1"):
        igusa_invariants(structure, width=-1)


@pytest.mark.parametrize("mesh", [families.torus(12, 8), families.cylinder(8, 4)], ids=["torus", "cylinder"])
def test_other_surfaces_have_none(mesh):
    with pytest.raises(TopologyError, match="closed surface of genus 2"):
        igusa_invariants(conformal_structure(surface_of(mesh)))


@pytest.mark.parametrize("seed", range(4))
def test_igusa_s_invariants_are_those_of_the_coefficients(seed):
    coefficients = [2, *(int(c) for c in np.random.default_rng(seed).integers(-5, 6, 5)), 1]
    omega = siegel_reduction(curve_period_matrix(coefficients)).period_matrix
    for ball, exact in zip(invariants(omega), sextics.absolute(coefficients), strict=True):
        assert abs(ball.value - float(exact)) <= ball.error + 1e-8 * max(abs(float(exact)), 1)
