"""Hyperelliptic surfaces of genus 3 by theta constants and half turns: no wrong answer at any resolution."""

from fractions import Fraction

import families
import flat_cones
import numpy as np
import pytest
import regular_maps
from curves import NATURAL
from holomorph import TopologyError, conformal_structure, curve_period_matrix, hyperelliptic, siegel_reduction
from holomorph.moduli.theta_constants import even_theta_constants
from solved import surface_of


def hexagon_of_holes(refine, jitter=0.0):
    """A slab with three holes that are not in a row."""
    cells = np.ones((7, 6, 1), dtype=bool)
    cells[1, 1] = cells[3, 4] = cells[5, 1] = False
    for axis in range(3):
        cells = np.repeat(cells, refine, axis=axis)
    mesh = families.voxel_surface(cells, ((3, 0),))
    noise = jitter * np.random.default_rng(1).uniform(-1, 1, mesh.vertices.shape)
    return families.replace(mesh, vertices=(mesh.vertices + noise) / refine)


def squares(right, up):
    """With flat vertices moved, so that no triangles show a symmetry."""
    return flat_cones.jittered(families.square_tiled(right, up, 4), seed=0)


# y^2 = x^7 - 1 and x^7 - x; three holes in a row, which a half turn about their row keeps; stairs of five squares: a
# half turn fixes the middles of all, those of 2 edges, and the cone point.
HYPERELLIPTIC = {
    "14-gon": lambda: flat_cones.regular_polygon(14),
    "12-gon": lambda: flat_cones.regular_polygon(12),
    "row": lambda: families.block_with_holes(3),
    "fine row": lambda: families.block_with_holes(3, refine=3),
    "stairs": lambda: squares([1, 0, 3, 2, 4], [0, 2, 1, 4, 3]),
}
OTHERS = {
    "Klein": regular_maps.klein_quartic,
    "Fermat": regular_maps.fermat_quartic,
    "triangle of holes": lambda: hexagon_of_holes(1),
    "fine triangle of holes": lambda: hexagon_of_holes(2, jitter=0.1),
    # The Wollmilchsau y^4 = x^3 - x, quaternions and their products with i and j: Herrlich & Schmithuesen (2008).
    "quaternions": lambda: squares([1, 4, 7, 2, 5, 0, 3, 6], [2, 3, 4, 5, 6, 7, 0, 1]),
}
WIDTHS = (None, 0.5, 0.1, 0.02)


def verdicts(mesh):
    surface = surface_of(mesh)
    return [hyperelliptic(conformal_structure(surface, bounds=width)).verdict for width in WIDTHS]


@pytest.mark.parametrize("name", HYPERELLIPTIC)
def test_hyperelliptic_surfaces_are_never_denied(name):
    found = verdicts(HYPERELLIPTIC[name]())
    assert set(found) <= {"yes", "undecided"}
    if "gon" in name:  # their triangles have the half turn
        assert found == ["yes"] * len(WIDTHS)


@pytest.mark.parametrize("name", OTHERS)
def test_other_surfaces_are_never_called_hyperelliptic(name):
    """And once a "no" is certain it stays."""
    found = verdicts(OTHERS[name]())
    assert set(found) <= {"no", "undecided"} and found == sorted(found, reverse=True)
    if name in ("Klein", "Fermat", "quaternions"):
        assert found[-1] == "no"


def test_the_exact_theta_constant_is_within_the_error():
    """The Klein quartic's, from the matrix of the smooth surface, which the symmetry makes that of the mesh."""
    r7 = 1j * np.sqrt(7)
    exact = [[-1 + 3 * r7, -2 - 2 * r7, -3 + r7], [-2 - 2 * r7, 4 + 4 * r7, -2 - 2 * r7]]
    exact = np.array([*exact, [-3 + r7, -2 - 2 * r7, -1 + 3 * r7]]) / 8
    least = min(abs(value) for value, _ in even_theta_constants(siegel_reduction(exact).period_matrix))
    for width in WIDTHS:
        found = hyperelliptic(conformal_structure(surface_of(regular_maps.klein_quartic()), bounds=width))
        assert abs(found.least - least) <= found.error and least > 0.1


@pytest.mark.parametrize("name", [name for name, points in NATURAL.items() if len(points) > 6])
def test_theta_constants_of_curves(name):
    """One of the 36 vanishes, to the error that follows from that of the periods, and no other."""
    omega = siegel_reduction(curve_period_matrix(np.poly(NATURAL[name]))).period_matrix
    found = sorted((abs(value), error) for value, error in even_theta_constants(omega, np.expm1(omega.error)))
    assert found[0][0] <= found[0][1] < 1e-3
    assert all(size > error for size, error in found[1:])


def test_rounding_of_theta_constants():
    """Jacobi: theta_3^4 = theta_2^4 + theta_4^4, in fractions, to the errors."""
    for height in np.random.default_rng(0).uniform(0.9, 3, 300):
        constants = [(Fraction(value.real), error) for value, error in even_theta_constants(np.array([[1j * height]]))]
        (three, _), (four, _), (two, _) = constants
        assert abs(three**4 - two**4 - four**4) <= sum(4 * abs(value) ** 3 * error for value, error in constants)


@pytest.mark.parametrize("change", [1e-5, 1e-3, 1e-1])
def test_errors_of_bounds(change):
    """theta_3(i y) is the sum of exp(-pi n^2 y): the lowest y within the bounds is the farthest."""
    n = np.arange(-9, 10)
    for height in (0.9, 1.5, 2.5):
        value, error = next(even_theta_constants(np.array([[1j * height]]), change))
        farthest = np.exp(-np.pi * n**2 * height * (1 - change)).sum()
        assert 0.6 * error < farthest - value.real <= error


def test_genus_two_is_always_hyperelliptic():
    assert hyperelliptic(conformal_structure(surface_of(families.block_with_holes(2)))).verdict == "yes"


@pytest.mark.parametrize("make", [regular_maps.bring_curve, lambda: families.cylinder(8, 4)], ids=["4", "boundary"])
def test_others_are_not_told(make):
    with pytest.raises(TopologyError, match="only if they are closed, of genus 1 to 3"):
        hyperelliptic(conformal_structure(surface_of(make())))


def test_theta_constants_of_a_torus():
    """Jacobi: theta_3^4 = theta_2^4 + theta_4^4; and theta_3(i) = pi^(1/4) / Gamma(3/4)."""
    (three, _), (four, _), (two, _) = even_theta_constants(np.array([[1j]]))
    assert abs(three - 1.0864348112133080) < 1e-14
    assert abs(three**4 - two**4 - four**4) < 1e-14
