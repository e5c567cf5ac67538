"""UV maps: exact jumps across seams, areas and periods (solver accuracy), quality recomputed from its definition."""

import families
import holomorph
import numpy as np
import pytest
from forms import edge_forms, wedge_matrix
from holomorph import conformal_structure
from solved import CLOSED, FLAT, solved, surface_of
from uv_jumps import corner_sides, jumps, triangle_areas

SOLVER = 1e-8  # of the largest UV edge or period
embedded = pytest.mark.parametrize("name", CLOSED)
everywhere = pytest.mark.parametrize("name", [*CLOSED, *FLAT])


def some_coefficients(structure, seed=4):
    g = len(structure.period_matrix)
    random = np.random.default_rng(seed)
    return random.normal(size=g) + 1j * random.normal(size=g)


# ---- what a UV map is ----------------------------------------------------------------------------


@embedded
def test_steps_are_the_values_of_the_form(name):
    """Along every side of every polygon the UVs change by Re and Im of sum_j c_j theta_j."""
    structure = solved(name)
    surface, c = structure.surface, some_coefficients(structure)
    uv = structure.uv(c)
    start, end = corner_sides(surface)
    form = c @ structure.holomorphic_forms
    step = edge_forms(structure).along(form[None], surface.corner_vertices[start], surface.corner_vertices[end])[0]
    difference = (uv[end] - uv[start]) @ [1, 1j] - step
    assert np.abs(difference).max() < SOLVER * np.abs(form).max()


@everywhere
def test_shape_and_type(name):
    structure = solved(name)
    uv = structure.uv(some_coefficients(structure))
    assert uv.shape == (len(structure.surface.corner_vertices), 2)
    assert uv.dtype == np.float64
    assert np.isfinite(uv).all()


@everywhere
def test_uv_is_linear_in_the_coefficients(name):
    structure = solved(name)
    c, d = some_coefficients(structure, 1), some_coefficients(structure, 2)
    rotated = structure.uv(1j * c) @ [1, 1j]
    assert np.abs(rotated - 1j * (structure.uv(c) @ [1, 1j])).max() < SOLVER * np.abs(rotated).max()
    total = structure.uv(c + d)
    assert np.abs(total - structure.uv(c) - structure.uv(d)).max() < SOLVER * np.abs(total).max()


@embedded
def test_seams_jump_by_translations_and_nothing_else_jumps(name):
    """The two copies of an edge have equal UV vectors; where no seam is, they are equal themselves."""
    structure = solved(name)
    surface = structure.surface
    uv = structure.uv(some_coefficients(structure))
    jump, keys = jumps(surface, uv)
    scale = np.abs(uv).max()
    assert np.abs(jump[:, 0] - jump[:, 1]).max() < SOLVER * scale
    seam = np.isin(keys, structure.edges[structure.seams].astype(np.int64) @ [len(surface.vertices), 1])
    assert np.abs(jump[~seam]).max() < SOLVER * scale
    assert seam.sum() == len(structure.seams)


@embedded
def test_integer_classes_jump_by_integers(name):
    structure = solved(name)
    random = np.random.default_rng(9)
    n, m = random.integers(-3, 4, (2, len(structure.gram_matrix)))
    jump, _ = jumps(structure.surface, structure.uv_of(n, m))
    assert np.abs(jump - np.rint(jump)).max() < SOLVER * max(1, np.abs(jump).max())
    assert np.abs(np.rint(jump)).max() >= 1


@embedded
def test_uv_of_a_class_is_its_harmonic_form(name):
    structure = solved(name)
    surface, start_end = structure.surface, corner_sides(structure.surface)
    start, end = (surface.corner_vertices[corner] for corner in start_end)
    steps = edge_forms(structure).along(structure.harmonic_forms, start, end)
    one = np.eye(len(structure.gram_matrix))
    uv = structure.uv_of(one[0], one[1])
    assert np.abs((uv[start_end[1]] - uv[start_end[0]]).T - steps[:2]).max() < SOLVER * np.abs(steps).max()


@embedded
def test_uv_and_uv_of_agree(name):
    """theta_j = sum_k P_kj h_k with its periods P over the loops, so Re and Im of P c are the n and m of c."""
    structure = solved(name)
    c = some_coefficients(structure)
    periods = edge_forms(structure).integrals(structure.holomorphic_forms, structure.homology_basis).T @ c
    step = structure.uv(c) - structure.uv_of(periods.real, periods.imag)
    assert np.abs(step - step[0]).max() < SOLVER * np.abs(structure.uv(c)).max()


@everywhere
def test_uv_area(name):
    """Signed UV area of the whole surface is c^H Im(Omega) c: it depends on the periods alone."""
    structure = solved(name)
    c = some_coefficients(structure)
    expected = np.real(c.conj() @ structure.period_matrix.imag @ c)
    areas = triangle_areas(structure.surface, structure.uv(c))
    assert abs(areas.sum() - expected) < SOLVER * max(expected, np.abs(areas).sum())


@embedded
def test_uv_area_of_integer_classes_is_an_integer(name):
    """Tiles over the surface: n W m^T with the wedge matrix W = minus the inverse of the intersections."""
    structure = solved(name)
    random = np.random.default_rng(10)
    n, m = random.integers(-3, 4, (2, len(structure.gram_matrix)))
    wedge = -np.rint(np.linalg.inv(structure.intersection_matrix)).astype(int)
    assert np.abs(wedge_matrix(structure, structure.harmonic_forms) - wedge).max() < SOLVER * len(wedge)
    areas = triangle_areas(structure.surface, structure.uv_of(n, m))
    assert abs(areas.sum() - n @ wedge @ m) < SOLVER * max(1, np.abs(areas).sum())


@pytest.mark.parametrize(
    ("call", "arguments"),
    [
        ("uv", [np.ones(3)]),
        ("uv", [np.ones((2, 1))]),
        ("uv", [[np.nan, 1]]),
        ("uv_of", [np.ones(4), np.ones(3)]),
        ("uv_of", [np.ones(2), np.ones(2)]),
        ("uv_of", [[np.inf, 0, 0, 0], np.ones(4)]),
        ("quality", [np.zeros((5, 2))]),
        ("quality", [np.zeros(7)]),
    ],
)
def test_wrong_arguments(call, arguments):
    with pytest.raises(ValueError, match="shape|finite"):
        getattr(solved("genus 2 block"), call)(*arguments)


# ---- quality -------------------------------------------------------------------------------------


def singular_values(surface, uv):
    """(#T, 2) of the map from each triangle in space to the plane, and the triangles' areas."""
    p, q = surface.vertices[surface.triangles], uv[surface.triangle_corners]
    a, b = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    length = np.linalg.norm(a, axis=1)
    height = np.linalg.norm(np.cross(a, b), axis=1) / length
    plane = np.zeros((len(p), 2, 2))
    plane[:, 0, 0], plane[:, 0, 1], plane[:, 1, 1] = length, (a * b).sum(axis=1) / length, height
    image = np.stack([q[:, 1] - q[:, 0], q[:, 2] - q[:, 0]], axis=2)
    return np.linalg.svd(image @ np.linalg.inv(plane), compute_uv=False), length * height / 2


@embedded
def test_quality_per_triangle(name):
    """s1 / s2, s1 s2 and the sign of the determinant. Where s2 nearly vanishes the quotient is compared as s2 / s1."""
    structure = solved(name)
    surface = structure.surface
    uv = structure.uv(some_coefficients(structure))
    quality = structure.quality(uv)
    values, _ = singular_values(surface, uv)
    assert np.abs(1 / quality.angle - values[:, 1] / values[:, 0]).max() < 1e-6
    assert (quality.angle >= 1).all()
    assert np.abs(quality.area - values.prod(axis=1)).max() < SOLVER * quality.area.max()
    areas = triangle_areas(surface, uv)
    clear = np.abs(areas) > SOLVER * np.abs(areas).max()
    assert (quality.flipped == (areas < 0))[clear].all()


def quality_and_areas(name):
    """The quality of some map, and the areas of the surface's triangles."""
    structure = solved(name)
    uv = structure.uv(some_coefficients(structure))
    return structure.quality(uv), singular_values(structure.surface, uv)[1]


@embedded
def test_mean_angle_and_flipped_part(name):
    quality, area = quality_and_areas(name)
    mean = (np.minimum(quality.angle, 10) * area).sum() / area.sum()
    assert abs(quality.mean_angle - mean) < 1e-9 * mean
    assert abs(quality.flipped_part - area[quality.flipped].sum() / area.sum()) < 1e-12


def test_one_triangle_does_not_decide_the_mean():
    structure = solved("even torus")
    uv = structure.uv([1]).copy()
    uv[structure.surface.triangle_corners[0]] = uv[0]
    quality = structure.quality(uv)
    assert quality.collapsed.sum() == 1
    assert quality.mean_angle < 1.1 * structure.quality(structure.uv([1])).mean_angle


@embedded
def test_density_ratio(name):
    """Quantiles by area: at most 5 % of the area is below the lower and above the upper one."""
    quality, area = quality_and_areas(name)
    order = np.argsort(quality.area)
    below = np.cumsum(area[order]) / area.sum()
    # One triangle may be counted to either side, or its value interpolated: the neighbours in order bracket the ratio.
    low, high = np.searchsorted(below, [0.05, 0.95])
    sorted_density = quality.area[order]
    last = len(order) - 1
    least = sorted_density[max(high - 1, 0)] / sorted_density[min(low + 1, last)]
    most = sorted_density[min(high + 1, last)] / sorted_density[max(low - 1, 0)]
    assert least * (1 - 1e-9) <= quality.density_ratio <= most * (1 + 1e-9)


@embedded
def test_median_density(name):
    quality, area = quality_and_areas(name)
    below = (quality.area < quality.median_density * (1 - 1e-9)) @ area
    above = (quality.area > quality.median_density * (1 + 1e-9)) @ area
    assert max(below, above) < (0.5 + 1e-9) * area.sum()


def test_quality_of_the_reversed_map():
    structure = solved("even torus")
    uv = structure.uv([1])
    straight, reversed_ = structure.quality(uv), structure.quality(uv * [1, -1])
    assert (straight.flipped != reversed_.flipped).all()
    assert np.abs(straight.angle - reversed_.angle).max() < 1e-9
    assert not straight.flipped.any()


def test_distortion_of_a_smooth_torus_falls_like_the_step():
    """Discretisation: mean s1 / s2 - 1 halves when the grid step does, as it is the error of linear interpolation."""
    excess = []
    for n in (24, 48, 96):
        structure = conformal_structure(surface_of(families.torus(n, n // 2, shape="triangles", seed=2)))
        excess.append(structure.quality(structure.uv([1])).mean_angle - 1)
    order = np.log2(np.array(excess[:-1]) / excess[1:])
    assert (order > 0.9).all(), order


# ---- frames --------------------------------------------------------------------------------------


@everywhere
@pytest.mark.parametrize("rotation", [0.0, 0.7])
def test_frame(name, rotation):
    structure = solved(name)
    uv = structure.uv(some_coefficients(structure))
    rotated = np.exp(1j * rotation) * (uv @ [1, 1j])
    frame = holomorph.frame(structure.surface, uv, rotation)
    size = np.abs(rotated).max()
    assert abs(frame.low - complex(rotated.real.min(), rotated.imag.min())) < 1e-12 * size
    assert abs(frame.high - complex(rotated.real.max(), rotated.imag.max())) < 1e-12 * size
    areas = np.abs(triangle_areas(structure.surface, uv))
    assert abs(frame.area - areas.sum()) < 1e-12 * areas.sum()


def test_wrong_frame():
    with pytest.raises(ValueError, match="uv has the shape"):
        holomorph.frame(solved("even torus").surface, np.zeros((3, 2)))


# ---- balance -------------------------------------------------------------------------------------


def log_variance(structure, coefficients):
    """Variance over the surface's area of log(s1 s2 / mean + 1e-4)."""
    uv = structure.uv(coefficients)
    density = structure.quality(uv).area
    _, area = singular_values(structure.surface, uv)
    share = area / area.sum()
    value = np.log(density / (density @ share) + 1e-4)
    return ((value - value @ share) ** 2) @ share


@everywhere
def test_balanced_map_has_area_one(name):
    structure = solved(name)
    c = structure.balanced_coefficients()
    assert c.shape == (len(structure.period_matrix),)
    assert abs(np.real(c.conj() @ structure.period_matrix.imag @ c) - 1) < SOLVER
    assert abs(triangle_areas(structure.surface, structure.uv(c)).sum() - 1) < SOLVER


@pytest.mark.parametrize("name", [name for name in CLOSED if CLOSED[name].genus > 1])
def test_balanced_map_is_more_even_than_any_form_of_the_basis(name):
    structure = solved(name)
    balanced = log_variance(structure, structure.balanced_coefficients())
    assert balanced <= min(log_variance(structure, form) for form in np.eye(len(structure.period_matrix)))


def test_balanced_map_does_not_depend_on_the_scale():
    structure = solved("genus 2 block")
    moved = conformal_structure(surface_of(families.moved(CLOSED["genus 2 block"], scale=1e3)))
    here, there = (log_variance(s, s.balanced_coefficients()) for s in (structure, moved))
    assert abs(here - there) < 0.1 * here  # the search is a finite one, and begins in another basis
