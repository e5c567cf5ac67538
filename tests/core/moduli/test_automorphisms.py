"""Automorphisms of surfaces whose groups are known, and reduced period matrices."""

import families
import numpy as np
import pytest
import regular_maps
from equivalence import distance_or_mirrored, gram_of, random_symplectic, symplectic_unit
from flint import acb
from holomorph import _native, automorphisms, conformal_structure, siegel_reduction
from holomorph.moduli.equivalence import period_lattice
from holomorph.moduli.symplectic import moved
from known_matrices import BOLZA, LAWSON
from shared_data import reference_surface
from solved import surface_of

ROUNDING = 1e-9
# The only matrix with the symmetries of the Klein quartic (Rauch & Lewittes 1970).
R7 = 1j * np.sqrt(7)
KLEIN = np.array(
    [
        [(-1 + 3 * R7) / 8, (-1 - R7) / 4, (-3 + R7) / 8],
        [(-1 - R7) / 4, (1 + R7) / 2, (-1 - R7) / 4],
        [(-3 + R7) / 8, (-1 - R7) / 4, (7 + 3 * R7) / 8],
    ]
)
REGULAR = {
    "Klein": regular_maps.klein_quartic,
    "Bring": regular_maps.bring_curve,
    "Fermat": regular_maps.fermat_quartic,
    "Macbeath": regular_maps.macbeath_curve,
}
FERMAT = (1 + 1j) / 2 * np.array([[2, 1, 1], [1, 2, 1], [1, 1, 2]])


def structure_of(name):
    if name in REGULAR:
        return conformal_structure(surface_of(REGULAR[name]()))
    if name == "square torus":
        return conformal_structure(surface_of(families.flat_torus(1j, 4)))
    if name == "hexagonal torus":
        return conformal_structure(surface_of(families.flat_torus(np.exp(1j * np.pi / 3), 4, jitter=0.2)))
    if name == "a torus":
        return conformal_structure(surface_of(families.torus(24, 18, jitter=0.2)))
    return conformal_structure(reference_surface(name))


ORDERS = {
    "square torus": 4,
    "hexagonal torus": 6,
    "a torus": 2,
    "omega2_squares4_level1.npz": 48,
    "omega3_squares6_level1.npz": 24,
    "decagon_jittered_16.npz": 10,
    "Klein": 336,
    "Bring": 240,
    "Fermat": 192,
    "Macbeath": 1008,
}


@pytest.mark.parametrize("name", ORDERS)
def test_order_of_the_group(name):
    structure = structure_of(name)
    found = automorphisms(structure)
    assert found.order == ORDERS[name] <= found.at_most
    wedge = np.rint(np.linalg.inv(structure.intersection_matrix))
    for R in found.generators:
        assert (R @ wedge @ R.T == wedge).all()
    assert order_generated(found.generators) == found.order


def test_the_search_goes_on_at_narrow_bounds():
    """The Macbeath curve, genus 7: the search ended without an answer where each row had a search of its own."""
    found = automorphisms(conformal_structure(surface_of(regular_maps.macbeath_curve()), bounds=0.02))
    assert found.order == found.at_most == 1008 and found.tolerance < 1e-2


def test_a_tolerance_finds_the_symmetries_of_the_smooth_surface():
    """The polyhedral Lawson surface has not all of them, and the bounds know."""
    structure = structure_of("lawson_xi21_32.obj")
    assert automorphisms(structure).at_most < 24
    found = automorphisms(structure, tolerance=0.05)
    assert found.order == 24 and 0 < found.tolerance < 0.05


def order_generated(generators):
    seen, fresh = set(), [np.eye(len(generators[0]), dtype=np.int64)]
    while fresh:
        seen |= {m.tobytes() for m in fresh}
        products = {(m @ g).tobytes(): m @ g for m in fresh for g in generators}
        fresh = [m for key, m in products.items() if key not in seen]
    return len(seen)


def test_the_klein_quartic_has_its_periods():
    assert distance_or_mirrored(structure_of("Klein").period_matrix, KLEIN) < ROUNDING


def bring_periods():
    """tau M with j(5 tau) = -25/2, Re tau = -1/2 (Riera & Rodriguez 1992): the symmetry alone leaves tau open."""
    low, high = 0.8661, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if acb(0.5, middle).modular_j().real < -12.5 else (middle, high)
    return (-0.5 + 0.2j * low) * np.array([[4, 1, -1, 1], [1, 4, 1, -1], [-1, 1, 4, 1], [1, -1, 1, 4]])


EXACT = {"Klein": KLEIN, "Bring": bring_periods()}


@pytest.mark.parametrize("bounds", [None, 0.02], ids=["as it is", "narrowed"])
@pytest.mark.parametrize("name", EXACT)
def test_exact_periods_are_within_the_bounds(name, bounds):
    structure = conformal_structure(surface_of(REGULAR[name]()), bounds=bounds)
    lattice, unit = period_lattice(structure), symplectic_unit(structure.surface.genus)
    exact = gram_of(EXACT[name])
    found, _ = _native.isometries(_native.PeriodLattice.closed(exact, unit), lattice, sign=1, slack=0.0, progress=None)
    nearest = min(found, key=lambda isometry: isometry.residual)
    R, residual = nearest.matrix, nearest.residual
    wedge = -np.rint(np.linalg.inv(structure.intersection_matrix))
    assert (R @ unit @ R.T == wedge).all()
    gram = R @ exact @ R.T
    native = structure._native
    assert np.linalg.eigvalsh(native.certain_gram_matrices()[0] - gram).min() > -ROUNDING
    assert np.linalg.eigvalsh(np.linalg.inv(gram) - native.inverse_gram_bounds()[0]).min() > -ROUNDING
    assert bounds is None or residual < bounds / 10  # the projected matrix is much nearer than its bounds


def test_automorphisms_belong_to_closed_surfaces():
    with pytest.raises(TypeError, match="closed surface, not a BoundedStructure"):
        automorphisms(conformal_structure(surface_of(families.cylinder(8, 4))))


# ---- reduced period matrices -----------------------------------------------------------------------------------

PERIODS = {"Bolza": BOLZA, "Lawson": LAWSON, "Fermat": FERMAT, "tau": np.array([[0.3 + 1.2j]])}


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    "omega", [BOLZA, LAWSON, FERMAT, np.array([[0.3 + 1.2j]])], ids=["Bolza", "Lawson", "Fermat", "tau"]
)
def test_reduced_matrices_keep_the_convention(omega, seed):
    g = len(omega)
    S = random_symplectic(g, seed, steps=3)
    scrambled = moved(omega, S)
    reduced = siegel_reduction(scrambled)
    M, J = reduced.matrix, symplectic_unit(g)
    assert (M @ J @ M.T == J).all()
    assert np.abs(moved(scrambled, M) - reduced.period_matrix).max() < 1e-6
    assert np.abs(reduced.period_matrix.real).max() <= 0.5 + ROUNDING
    assert abs(reduced.period_matrix[0, 0]) >= 1 - ROUNDING
    if g == 1:
        assert abs(reduced.period_matrix[0, 0] - omega[0, 0]) < ROUNDING


@pytest.mark.parametrize("tau", [-0.5 + 2j, np.exp(2j * np.pi / 3), np.exp(1j * 1.8), 0.5 + 0.1j])
def test_edge_of_the_fundamental_domain(tau):
    reduced = siegel_reduction([[tau]]).period_matrix[0, 0]
    assert abs(reduced) >= 1 - ROUNDING and -ROUNDING <= reduced.real <= 0.5 + ROUNDING


def test_what_is_no_period_matrix():
    with pytest.raises(ValueError, match="square, symmetric and finite"):
        siegel_reduction([[1j, 0.1], [0, 1j]])
    with pytest.raises(ValueError, match="positive definite"):
        siegel_reduction([[-1j]])
