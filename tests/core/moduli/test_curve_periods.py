"""Period matrices of curves against lattices, theta constants and symmetric curves that are known."""

import numpy as np
import pytest
import sextics
from equivalence import distance
from holomorph import curve_period_matrix
from holomorph.igusa import invariants
from holomorph.siegel import siegel_reduction
from known_matrices import BOLZA, LAWSON


def random_coefficients(degree, seed):
    real, imaginary = np.random.default_rng(seed).normal(size=(2, degree + 1))
    return real + 1j * imaginary


@pytest.mark.parametrize("degree", range(3, 13))
def test_they_are_period_matrices(degree):
    """Riemann's relations, which no wrong sign of a loop or a root leaves true."""
    omega = curve_period_matrix(random_coefficients(degree, degree))
    assert omega.shape == ((degree - 1) // 2,) * 2
    assert (omega == omega.T).all()
    assert np.linalg.eigvalsh(omega.imag).min() > 0


def arithmetic_geometric(a, b):
    while abs(a - b) > 1e-15 * abs(a):
        a, b = (a + b) / 2, np.sqrt(a * b) * np.sign((np.sqrt(a * b) / (a + b)).real)
    return a


@pytest.mark.parametrize("root", [0.3 + 0.2j, -1.1 + 0.4j, 0.5 - 0.8j, 0.25])
def test_elliptic_curves_by_the_arithmetic_geometric_mean(root):
    """y^2 = x (x - 1) (x - root): tau = i M(1, k') / M(1, k), k^2 = root. The mirror image has -conj(tau)."""
    tau = 1j * arithmetic_geometric(1, np.sqrt(1 - root)) / arithmetic_geometric(1, np.sqrt(complex(root)))
    ours = siegel_reduction(curve_period_matrix(np.poly([0, 1, root]))).period_matrix
    expected = siegel_reduction([[tau]]).period_matrix
    assert abs(ours - expected).max() < 1e-11


@pytest.mark.parametrize(
    ("coefficients", "exact"), [([1, 0, 0, 0, -1, 0], BOLZA), ([1, 0, 0, 0, 0, 0, -1], LAWSON)], ids=["Bolza", "Lawson"]
)
def test_symmetric_curves(coefficients, exact):
    assert distance(curve_period_matrix(coefficients), exact) < 1e-11


@pytest.mark.parametrize("seed", range(4))
def test_igusa_s_invariants_are_those_of_the_coefficients(seed):
    coefficients = [2, *(int(c) for c in np.random.default_rng(seed).integers(-5, 6, 5)), 1]
    omega = siegel_reduction(curve_period_matrix(coefficients)).period_matrix
    for ball, exact in zip(invariants(omega), sextics.absolute(coefficients), strict=True):
        assert abs(ball.value - float(exact)) <= ball.error + 1e-8 * max(abs(float(exact)), 1)


def test_scale_and_place_of_the_roots_do_not_matter():
    roots = np.roots(random_coefficients(5, 3))
    exact = siegel_reduction(curve_period_matrix(np.poly(roots))).period_matrix
    for scale, shift in ((1e-8, 0), (1e6, 0), (1j, 0.3), (-1, 2 - 1j)):
        other = curve_period_matrix(np.poly(scale * (roots + shift)))
        assert distance(other, exact) < 1e-9


@pytest.mark.parametrize(
    ("coefficients", "reason"),
    [
        ([1, 2, 1], "degree 2"),
        ([0, 0, 0, 0], "degree 0"),
        ([1, 0, 0, np.inf], "finite numbers"),
        ([[1, 0, 0, 1]], "finite numbers"),
        (np.poly([0, 0, 1, 2, 3]), "multiple root"),
    ],
)
def test_what_is_no_curve(coefficients, reason):
    with pytest.raises(ValueError, match=reason):
        curve_period_matrix(coefficients)
