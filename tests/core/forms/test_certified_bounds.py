"""Bounds that are proven: on flat surfaces with exact values, against 200 bits, with any functions."""

import re
from dataclasses import replace
from fractions import Fraction

import families
import flat_cones
import numpy as np
import pytest
import slow_path
from holomorph import SolverError, Surface, _native, conformal_structure, report
from holomorph.forms.certificate import certain_text, entry_bounds
from small_families import SMALL
from solved import surface_of

ORDERS = (1, 2, 5, 10)  # of elements
TIGHT = 1e-11  # relative width where the forms are represented exactly: rounding alone
ORIGAMIS = flat_cones.origamis()


def as_fractions(array):
    return np.vectorize(Fraction, otypes=[object])(np.asarray(array))


def least_eigenvalue(matrix):
    return np.linalg.eigvalsh(matrix).min()


# ---- square-tiled surfaces: the energy of dz is the area, exactly -------------------------------------------------


def jittered(flat, k, seed):
    """Vertices inside squares and on their sides moved: other lengths of the same surface. Returns it, and dz."""
    dz = flat_cones.differential(flat, len(flat.faces), k)
    random = np.random.default_rng(seed)
    count = flat.faces.max() + 1
    noise = 0.15 / k * random.uniform(-1, 1, (count, 2)) @ [1, 1j]
    corners = flat.faces.reshape(-1, 2, 3)[
        :: k * k
    ]  # corners of the squares' first cells: their corner 0 is a square's
    noise[corners[:, 0, 0]] = 0
    starts, ends = np.roll(flat.faces, -1, axis=1), np.roll(flat.faces, -2, axis=1)
    dz = dz + noise[ends] - noise[starts]
    return replace(flat, edge_lengths=np.abs(dz)), dz


def periods(structure, flat, dz):
    """The periods of dz over the homology basis, Gaussian integers: dz in the basis of the harmonic forms."""
    native = structure.surface._native
    tails, heads = native.triangles, np.roll(native.triangles, -1, axis=1)
    assert (native.triangles == flat.faces).all()
    assert (tails != heads).all()
    signs = np.where(tails < heads, 1, -1)
    values = structure.harmonic_forms[:, native.triangle_edges] * signs
    along = dz[:, [2, 0, 1]]
    found, *_ = np.linalg.lstsq(values.reshape(len(values), -1).T, along.ravel(), rcond=None)
    integers = np.rint(found.real) + 1j * np.rint(found.imag)
    assert np.abs(found - integers).max() < 1e-6
    return integers


def energy(form, x):
    """x form x, without rounding."""
    return as_fractions(x) @ as_fractions(form) @ as_fractions(x)


@pytest.mark.parametrize("is_jittered", [False, True], ids=["even", "jittered"])
@pytest.mark.parametrize("name", ORIGAMIS)
def test_the_area_of_a_square_tiled_surface(name, is_jittered):
    """The energies of Re dz and Im dz are the number of squares. They are represented exactly, so the bounds of the
    Gram matrix meet there up to their rounding."""
    right, up = ORIGAMIS[name]
    flat = families.square_tiled(right, up, 3)
    assert flat.genus == int(name.split(",")[0].split()[1])
    dz = flat_cones.differential(flat, len(flat.faces), 3)
    if is_jittered:
        flat, dz = jittered(flat, 3, seed=len(right))
    structure = conformal_structure(surface_of(flat))
    native, W = structure._native, structure._native.pairing()
    c = periods(structure, flat, dz)
    for order in (None, *ORDERS):
        if order is not None:
            level = _native.solve_level(native.surface(), native.side_classes(), len(W), order, 1, None)
            native.narrow(level.energies.gram, level.energies.certain, metric_error=level.errors.max())
        for x in (c.real, c.imag):
            lower = energy(native.inverse_gram_bounds()[0], W.T @ x)
            upper = energy(native.certain_gram_matrices()[0], x)
            assert lower <= len(right) <= upper
            assert upper - lower < (1 if order is None else 5) * TIGHT * len(right)
    assert structure.certificate.holds
    a = (structure.canonical_basis @ c)[: flat.genus]  # dz = sum_j a_j theta_j
    lower, upper = (energy(b, a.real) + energy(b, a.imag) for b in structure.certificate.imaginary_bounds)
    assert lower <= len(right) <= upper


# ---- against 200 bits ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SMALL)
def test_200_bits(name):
    """The slow path finds the least energies; what was solved in doubles is not below them, and hardly above."""
    surface = surface_of(SMALL[name])
    structure = conformal_structure(surface)
    assert structure.flip_count == 0
    native = surface._native
    tails, heads = native.triangles, np.roll(native.triangles, -1, axis=1)
    signs = np.where(tails < heads, 1, -1)
    values = np.moveaxis(structure.harmonic_forms[:, native.triangle_edges] * signs, 0, 2)
    classes = slow_path.integer_classes(native.triangles, values)
    squares = slow_path.squared_sides(surface.vertices, native.triangles)
    gram = slow_path.least_gram(native.triangles, squares, classes)
    lower, upper = slow_path.imaginary_bounds(gram, structure.canonical_basis)
    found_lower, found_upper = structure.certificate.imaginary_bounds
    assert least_eigenvalue(slow_path.difference(lower, found_lower)) > 0
    assert least_eigenvalue(-slow_path.difference(upper, found_upper)) > 0
    width, found_width = (upper - lower).astype(float), found_upper - found_lower
    assert least_eigenvalue(1.5 * width - found_width) > 0


# ---- whatever the solver did --------------------------------------------------------------------------------------


@pytest.mark.parametrize("noise", [1e-12, 1e-6, 1e-3, 1.0])
@pytest.mark.parametrize("order", [1, 2, 4])
def test_any_functions_give_bounds(order, noise):
    """An unfinished solution: its energies are above the least ones, in every direction."""
    mesh = families.block_with_holes(2, refine=2, jitter=0.2)
    structure = conformal_structure(surface_of(mesh))
    native, classes = structure._native, structure._native.side_classes()
    level = _native.solve_level(native.surface(), classes, 4, order, 1, None)
    moved = level.functions + noise * np.random.default_rng(1).standard_normal(level.functions.shape)
    above, (gram,) = _native.measure_level(native.surface(), classes, 4, order, moved).certain, level.energies.gram
    if order == 1:
        assert least_eigenvalue(_native.measure(native.surface(), classes, 4, moved).certain[0] - gram) > 0
    assert least_eigenvalue(above[0] - gram) > 0
    assert least_eigenvalue(level.energies.certain[0] - gram) > 0


# ---- the certificate ----------------------------------------------------------------------------------------------


def test_certificate_of_a_closed_surface():
    structure = conformal_structure(surface_of(families.block_with_holes(2, refine=2, jitter=0.2)))
    certificate = structure.certificate
    lower, upper = certificate.imaginary_bounds
    omega = structure.period_matrix
    assert certificate.holds and certificate.reason == ""
    assert least_eigenvalue(omega.imag - lower) > 0 and least_eigenvalue(upper - omega.imag) > 0
    low, high = certificate.real_bounds
    assert (low < omega.real).all() and (omega.real < high).all()
    assert certificate.relative_width == pytest.approx(
        np.linalg.eigvals(np.linalg.solve(omega.imag, upper - lower)).real.max()
    )
    assert 0 < certificate.asymmetry < 1 and 0 < certificate.star_defect < 1
    assert certificate.smallest_eigenvalue == pytest.approx(np.linalg.eigvalsh(omega.imag)[0])
    assert max(certificate.closedness, certificate.co_closedness, certificate.period_error) < 1e-9
    assert 0 < certificate.rounding < 1e-9


def test_certificate_says_where_bounds_do_not_hold():
    handle = families.torus(12, 8, shape="triangles")
    vertices = handle.vertices.copy()
    vertices[1] = vertices[0]
    certificate = conformal_structure(Surface(vertices, handle.corners.reshape(-1, 3))).certificate
    assert not certificate.holds
    assert "differs slightly" in certificate.reason or "leaves its shape uncertain" in certificate.reason


def test_certificate_of_streamed_forms():
    surface = surface_of(families.block_with_holes(8))
    with pytest.raises(SolverError) as refusal:
        conformal_structure(surface, memory_limit=1)
    least = int(re.search(r"at least (\d+) bytes", str(refusal.value))[1])
    certificate = conformal_structure(surface, memory_limit=least).certificate
    assert not certificate.holds and "in blocks" in certificate.reason


def test_certificate_of_a_bounded_surface():
    structure = conformal_structure(surface_of(families.square_minus_square(4, jitter=0.2)))
    certificate = structure.certificate
    assert certificate.holds and np.isnan(certificate.asymmetry)
    low, high = (bound[0, 0] for bound in structure.capacity_bounds)
    assert low < 10.234092569368052 < high
    assert structure.modulus_bounds[0] < 1 / 10.234092569368052 < structure.modulus_bounds[1]


def test_entries_between_two_quadratic_forms():
    """In exact arithmetic: the middle, and as much to both sides as the root of the product of half widths. Those off
    the diagonal are rounded most."""
    random = np.random.default_rng(0)
    for scale in 10.0 ** random.uniform(-17, 0, 4000):
        middle, width = random.uniform(1, 2, (2, 2)) * [[0.01, 1], [1, 0.01]], np.diag(scale * random.uniform(0, 1, 2))
        lower, upper = middle + middle.T - width, middle + middle.T + width
        low, high = map(as_fractions, entry_bounds(lower, upper))
        exact_lower, exact_upper = as_fractions(lower), as_fractions(upper)
        half = np.diag(exact_upper - exact_lower) / 2
        exact = (exact_lower + exact_upper) / 2
        squares = np.outer(half, half)
        for below in (exact - low, high - exact):
            assert (below >= 0).all() and (below * below >= squares).all()


# ---- texts --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("middle", [2.17853, -1e-9, 0.0, 3.3e30])
@pytest.mark.parametrize("radius", [4.8e-3, 9.97e-7, 1e-13, 25.0])
def test_texts_hold_both_bounds(middle, radius):
    lower, upper = middle - radius, middle + radius
    shown, error = map(Fraction, certain_text(lower, upper).split(" +- ")) if lower < upper else (Fraction(lower), 0)
    assert shown - error <= Fraction(lower) and Fraction(upper) <= shown + error
    assert error <= 3 * (Fraction(upper) - Fraction(lower))


def test_reports_have_texts():
    structure = conformal_structure(surface_of(families.square_minus_square(4, jitter=0.2)))
    plain = report.component_report(structure.surface, structure)
    assert " +- " in plain["modulus_text"]
    assert " +- " in plain["certificate"]["period_text"][0][0][1]
