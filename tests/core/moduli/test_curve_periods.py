"""Period matrices of curves against lattices, theta constants and symmetric curves that are known."""

import pickle
import re
from decimal import Decimal, localcontext
from fractions import Fraction

import curves
import numpy as np
import pytest
import sextics
from equivalence import distance
from holomorph import SolverError, conformally_equivalent, curve_period_matrix
from holomorph.forms.period_matrix import distance_within
from holomorph.moduli import curve_periods
from holomorph.moduli.igusa import invariants
from holomorph.moduli.siegel import siegel_reduction
from known_matrices import BOLZA, LAWSON

EPS = np.finfo(float).eps


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


def exact_height(roots):
    """Im tau >= 1 of y^2 = (x - p) (x - q) (x - r), to 40 digits of decimal arithmetic; Re tau = 0."""
    p, q, r = map(Decimal, sorted(roots))

    def mean(a, b):
        while abs(a - b) > Decimal("1e-40") * a:
            a, b = (a + b) / 2, (a * b).sqrt()
        return a

    with localcontext(prec=50):
        quotient = mean(Decimal(1), ((q - p) / (r - p)).sqrt()) / mean(Decimal(1), ((r - q) / (r - p)).sqrt())
        return max(quotient, 1 / quotient)


def part_of_error(coefficients, roots):
    """Distance of the exact period, as a part of the error that is claimed."""
    omega = curve_period_matrix(coefficients)
    tau, exact = siegel_reduction(omega).period_matrix.item(), exact_height(roots)
    with localcontext(prec=50):
        return np.hypot(float(Decimal(tau.imag) / exact - 1), tau.real / float(exact)) / omega.error


def parts_of_errors(sizes):
    """Those of curves with integers for roots."""
    random, parts = np.random.default_rng(0), []
    for size in np.repeat(sizes, 60):
        p, q, r = map(int, random.choice(size, 3, replace=False) - size // 2)
        parts.append(part_of_error([1, -(p + q + r), p * q + q * r + r * p, -p * q * r], [p, q, r]))
    return parts


def test_no_period_is_farther_than_its_error():
    """What is wrong is rounding, and some of it a hundredth of what is claimed."""
    assert 0.01 < max(parts_of_errors(10 ** np.arange(1, 6))) <= 1


@pytest.mark.parametrize("truncation", [1e-2, 1e-4, 1e-6])
def test_no_period_is_farther_than_the_truncation_of_its_integrals(monkeypatch, truncation):
    """With so few nodes that rounding is nothing to it."""
    monkeypatch.setattr(curve_periods, "TRUNCATION", truncation)
    assert 0.001 < max(parts_of_errors(10 ** np.arange(1, 4))) <= 1


def exact_polynomial(roots):
    """Coefficients of the product of x - root, in fractions."""
    c = [Fraction(1)]
    for root in map(Fraction, roots):
        c = [a - root * b for a, b in zip([*c, 0], [0, *c], strict=True)]
    return c


def test_coefficients_as_wrong_as_a_product_of_factors():
    """Each by 2 units for each factor, all in the direction that moves a positive root most."""
    random, parts = np.random.default_rng(1), []
    for _ in range(200):
        roots = np.sort(random.uniform(-1, 1, 3)) + random.uniform(2, 50)
        if np.diff(roots).min() > 0.05:
            wrong = [1, *(c + 6 * Fraction(EPS) * abs(c) for c in exact_polynomial(roots)[1:])]
            parts.append(part_of_error([float(c) for c in wrong], roots))
    assert 0.1 < max(parts) <= 1


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


# ---- curves that leave no natural order of their branch points -------------------------------------------------


def points_of(kind, seed):
    random = np.random.default_rng(seed)
    return curves.random_points(kind, int(random.integers(5, 9)), random)


def assert_thomae(omega, points):
    """To the error that is claimed, and to that of theta series."""
    expected, found = curves.thomae_sizes(points), curves.theta_sizes(omega)
    # The derivative of log theta by the distance of period matrices is some 10 on reduced ones.
    assert np.abs(found - expected).max() <= 1e-11 + 10 * expected.max() * omega.error
    assert omega.error < 0.1


@pytest.mark.parametrize("name", curves.NATURAL)
def test_natural_curves_have_the_theta_constants_of_their_branch_points(name):
    points = curves.NATURAL[name]
    assert_thomae(curve_period_matrix(np.poly(points)), points)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("kind", curves.KINDS)
def test_random_curves_have_the_theta_constants_of_their_branch_points(kind, seed):
    points = points_of(kind, seed)
    assert_thomae(curve_period_matrix(np.poly(points)), points)


def assert_equivalent(first, second):
    found = conformally_equivalent(first, second)
    assert found.verdict in ("equivalent", "indistinguishable", "mirror_image"), found.sentence
    assert found.residual <= found.tolerance / 2 and (found.tolerance <= 1e-8) == found.is_proven


@pytest.mark.parametrize("name", curves.NATURAL)
def test_natural_curves_are_their_moebius_images(name):
    random = np.random.default_rng(1)
    first = curve_period_matrix(np.poly(curves.NATURAL[name]))
    assert_equivalent(first, curve_period_matrix(np.poly(1j * curves.NATURAL[name])))
    assert_equivalent(first, curve_period_matrix(np.poly(curves.moebius_image(curves.NATURAL[name], random))))


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("kind", curves.KINDS)
def test_random_curves_are_their_moebius_images(kind, seed):
    points = points_of(kind, seed)
    images = curves.moebius_image(points, np.random.default_rng(seed))
    assert_equivalent(*(curve_period_matrix(np.poly(each)) for each in (points, images)))


def test_curves_that_differ_by_little_are_told_apart():
    """y^2 = x (x - 1) (x - 2) (x - 3) (x - 5), with its last branch point moved; and what bounds do not tell."""
    first = curve_period_matrix(np.poly([0, 1, 2, 3, 5]))
    verdicts = {1e-2: "not_equivalent", 1e-7: "not_equivalent", 1e-9: "indistinguishable", 1e-14: "equivalent"}
    for step, verdict in verdicts.items():
        found = conformally_equivalent(first, curve_period_matrix(np.poly([0, 1, 2, 3, 5 + step])))
        assert found.verdict == verdict and found.margin < max(step, 1e-9)


@pytest.mark.parametrize("kind", curves.KINDS)
def test_errors_of_coefficients_are_within_the_error(kind):
    """Each moved by its last bit, they belong to curves that are not told apart."""
    c = np.poly(points_of(kind, 3))
    moved = c * (1 + EPS * np.random.default_rng(2).choice([-1, 1], len(c)))
    first, second = curve_period_matrix(c), curve_period_matrix(moved)
    assert conformally_equivalent(first, second).residual <= first.error + second.error


def test_the_error_stays_with_the_matrix():
    omega = curve_period_matrix(np.poly(points_of("clusters", 0)))
    assert omega.error > 0 and not omega.flags.writeable
    reduced, copied = siegel_reduction(omega).period_matrix, pickle.loads(pickle.dumps(omega))
    for same in (reduced, copied, -omega.conj(), omega[::-1, ::-1]):
        assert same.error == omega.error


def test_a_matrix_is_as_exact_as_it_is_symmetric():
    exact = curve_period_matrix([1, 0, 0, 0, -1, 0])
    skew = np.array(exact)
    skew[0, 1] += 1e-9
    assert 1e-10 < conformally_equivalent(exact, skew).tolerance < 1e-8


@pytest.mark.parametrize("apart", [1e-12, 1e-10, 1e-9])
def test_either_side_of_a_matrix_may_be_the_exact_one(apart):
    """[[i, x], [x, i]] is i + x on the diagonal: 2 asinh(x / 4) from the middle, once for each of both matrices."""
    skew = np.array([[1j, apart], [0, 1j]])
    tolerance = conformally_equivalent(skew, skew).tolerance
    assert 4 * np.arcsinh(apart / 4) <= tolerance < 2 * apart


@pytest.mark.parametrize("change", [1e-6, 0.1, 0.5, 0.9])
@pytest.mark.parametrize("tau", [1j, 0.3 + 1.7j, -0.4 + 0.9j])
def test_the_farthest_torus(tau, change):
    """Im tau less a part of itself: further up the half-plane, or to a side, is not so far."""
    found = distance_within(np.array([[tau]]), np.array([[change * tau.imag]]))
    assert found == pytest.approx(-np.log(1 - change), rel=1e-9)


def test_no_bound_where_a_torus_may_be_none():
    assert distance_within(np.array([[1j]]), np.array([[1.0]])) == np.inf


def test_integer_coefficients_are_exact():
    """Far from 0 the coefficients have 12 digits, of which rounding would leave none to the periods."""
    points = np.array([100, 101, 102, 103, 104, 106])
    far, near = (curve_period_matrix(np.poly(points - shift)) for shift in (0, 103))
    assert far.error < 1e-11 and conformally_equivalent(far, near).verdict == "equivalent"
    assert curve_period_matrix(np.poly(points) * 1.1).error > 1e-6


@pytest.mark.parametrize("apart", [1e-5, 1e-7])
def test_near_branch_points_have_more_nodes(apart):
    points = np.array([0, apart, 1, 2j, 3])
    assert_thomae(curve_period_matrix([complex(c) for c in np.poly(points)]), points)


def test_branch_points_may_be_too_near():
    with pytest.raises(SolverError, match="two branch points are too close together"):
        curve_period_matrix([2.0**80, -(2.0**80), -1, 1])  # 1 and +- 2^-40


@pytest.mark.parametrize("seed", range(20))
def test_coefficients_of_any_size_have_periods_or_are_refused(seed):
    random = np.random.default_rng(seed)
    c = random.normal(size=6) * 10.0 ** random.uniform(-40, 40, 6)
    try:
        omega = curve_period_matrix(c)
    except (ValueError, SolverError) as error:
        assert re.search("too close together|closer together than|too small beside", str(error))
    else:
        assert conformally_equivalent(omega, omega).verdict in ("equivalent", "indistinguishable")


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
        (np.poly([1, 1, 2, 3, 5]), "multiple root"),
        (np.poly([0.1, 0.1 + 1e-9, 1, 2, 3]), "multiple root"),
        ([1e-320, 1, 0, 0, 1], "first coefficient is too small"),
    ],
)
def test_what_is_no_curve(coefficients, reason):
    with pytest.raises(ValueError, match=reason):
        curve_period_matrix(coefficients)
