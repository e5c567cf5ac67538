"""Bounds as narrow as asked for: reached, nested, right, and by fewer triangles where they are needed."""

import families
import flat_cones
import numpy as np
import pytest
from equivalence import distance_or_mirrored
from holomorph import (
    SolverError,
    Surface,
    TopologyError,
    _native,
    conformal_structure,
    conformally_equivalent,
)
from holomorph.forms.narrow_bounds import count_with_layers, triangles_of_level
from holomorph.forms.refined_triangles import with_layers
from shared_data import complex_matrix, reference_values, shared_folder
from solved import surface_of

SQUARE_MINUS_SQUARE = 10.234092569368052  # its capacity, see test_boundary_values

WIDTH = 5e-3
ROUNDING = 1e-11

GRADED = {
    "decagon": flat_cones.regular_polygon(10),
    "L-shape": families.square_tiled([1, 0, 2], [2, 1, 0], 1),
    "octagon": flat_cones.regular_polygon(8),
}


@pytest.mark.parametrize("name", GRADED)
def test_bounds_are_as_narrow_as_asked_for_and_nested(name):
    surface = surface_of(GRADED[name])
    wide = conformal_structure(surface).period_bounds
    structure = conformal_structure(surface, bounds=WIDTH)
    assert structure.refinement.reached
    widths = [width for _, width in structure.refinement.levels]
    assert widths[-1] <= WIDTH < widths[-2]
    assert (np.diff(widths) <= 0).all()
    assert len(structure.refinement.orders) == len(widths)
    assert structure.certificate.relative_width == widths[-1]
    assert structure.certificate.holds
    (lower, upper), (wide_lower, wide_upper) = structure.period_bounds, wide
    assert np.linalg.eigvalsh(lower - wide_lower).min() > -ROUNDING
    assert np.linalg.eigvalsh(wide_upper - upper).min() > -ROUNDING
    assert np.linalg.eigvalsh(structure.period_matrix.imag - lower).min() > 0


@pytest.mark.parametrize("seed", range(3))
def test_the_published_error_is_beaten_on_a_jittered_mesh(seed):
    """Bobenko, Mercat & Schmies (2011) on as many vertices, with the symmetric mesh."""
    values = reference_values()
    with np.load(shared_folder("reference") / "meshes" / "omega2_squares4_level2.npz") as arrays:
        flat = flat_cones.by_edge_lengths(arrays["faces"], arrays["edge_lengths"])
    for k in range(4):
        flat = flat_cones.jittered(flat, 10 * seed + k)
    exact = complex_matrix(values["genus2"]["omega2_squares4"])
    given = surface_of(flat)
    assert distance_or_mirrored(conformal_structure(given).period_matrix, exact) > ROUNDING  # no symmetry fixes it
    structure = conformal_structure(given, bounds=ROUNDING, most_faces=2 * (4094 - 2 + 2 * 2))
    error = distance_or_mirrored(structure.period_matrix, exact)
    assert error < values["published_errors"]["omega2_squares4"]["4094"]


def test_capacity_of_a_square_minus_a_square():
    structure = conformal_structure(surface_of(families.square_minus_square(2, jitter=0.2)), bounds=1e-3)
    low, high = (bound[0, 0] for bound in structure.capacity_bounds)
    assert low < SQUARE_MINUS_SQUARE < high and high - low < 1.01e-3 * high
    assert low < structure.capacity_matrix[0, 0] < high


def test_a_torus_with_holes():
    structure = conformal_structure(surface_of(families.punched(families.torus(12, 9), 3)), bounds=2e-2)
    assert structure.refinement.reached
    lower, upper = structure.period_bounds
    assert np.linalg.eigvalsh(structure.period_matrix.imag - lower).min() > 0
    assert np.linalg.eigvalsh(upper - structure.period_matrix.imag).min() > 0


def test_what_cannot_be_reached_is_said():
    refinement = conformal_structure(surface_of(GRADED["decagon"]), bounds=1e-9, most_faces=500).refinement
    assert not refinement.reached
    assert "more than 500" in refinement.reason
    assert refinement.levels[-1][0] <= 500


@pytest.mark.parametrize("bounds", [0, -1e-3, 1, np.nan, "narrow"])
def test_widths_that_mean_nothing(bounds):
    with pytest.raises(ValueError, match="bounds is"):
        conformal_structure(surface_of(GRADED["decagon"]), bounds=bounds)


def test_surfaces_without_periods():
    with pytest.raises(TopologyError, match="genus 0 has no holomorphic forms"):
        conformal_structure(surface_of(families.block_with_holes(0)), bounds=1e-3)


def test_uvs_remain():
    """They are those of the surface's own triangles."""
    surface = surface_of(families.block_with_holes(2, refine=2))
    plain, narrowed = conformal_structure(surface), conformal_structure(surface, bounds=0.05)
    assert len(narrowed.refinement.levels) > 1
    assert np.abs(plain.harmonic_forms - narrowed.harmonic_forms).max() == 0
    assert narrowed.uv(narrowed.balanced_coefficients()).shape == plain.uv(plain.balanced_coefficients()).shape
    assert np.abs(narrowed.period_matrix - plain.period_matrix).max() < 0.05 * np.abs(plain.period_matrix).max()


def test_progress_is_told_by_level():
    stages = []
    conformal_structure(
        surface_of(GRADED["octagon"]), bounds=0.02, progress=lambda _, stage: stages.append(stage) or True
    )
    assert any(stage.startswith("level 2") for stage in stages)


def test_memory_limits_it():
    """The bounds of the levels before hold."""
    structure = conformal_structure(surface_of(GRADED["decagon"]), bounds=1e-8, memory_limit=1_000_000)
    assert not structure.refinement.reached and "memory_limit" in structure.refinement.reason
    assert structure.refinement.levels[-1][1] < structure.refinement.levels[0][1] / 2
    assert structure.certificate.holds


def test_cones_too_sharp_for_layers_are_said():
    """Angle 98 pi: forms like r^(1/49), whose layers would have 4^-200 of its size."""
    refinement = conformal_structure(surface_of(flat_cones.regular_polygon(100)), bounds=1e-2).refinement
    assert not refinement.reached and "smaller than numbers can be" in refinement.reason


@pytest.mark.parametrize("seed", range(5))
def test_triangles_are_counted_before_they_are_made(seed):
    native = conformal_structure(surface_of(families.block_with_holes(2)))._native
    solved = _native.solve_level(native.surface(), native.side_classes(), 4, 1, 1, None)
    triangles = triangles_of_level(solved)
    layers = np.random.default_rng(seed).integers(-4, 5, triangles.corners.max() + 1).clip(0)
    assert count_with_layers(triangles, layers) == len(with_layers(triangles, layers).corners)


def test_energies_that_are_refused_leave_the_structure():
    """Those below the exact ones: their bounds cross."""
    structure = conformal_structure(surface_of(GRADED["octagon"]))
    native, periods = structure._native, structure.period_matrix.copy()
    too_small = [0.1 * gram for gram in native.gram_matrices()]
    with pytest.raises(SolverError, match="cross"):
        native.narrow(too_small, too_small, metric_error=0.0)
    assert (native.period_matrix() == periods).all() and len(native.side_classes()) == 8


def torus_with_inner_vertices(tau, weights):
    """Two triangles with the corners 0, 1 and tau, each divided at the point with these weights of its corners."""
    corners = np.array([0, 1, tau])
    inner = corners @ weights
    faces, lengths, names = [], [], []
    for k in range(2):
        for i in range(3):
            j, m = (i + 1) % 3, (i + 2) % 3  # the side opposite i, as are the names 0 to 2
            faces.append((0, 0, 1 + k))
            lengths.append(np.abs([corners[m] - inner, inner - corners[j], corners[j] - corners[m]]))
            names.append((3 + 3 * k + m, 3 + 3 * k + j, i))
    return Surface.from_edge_lengths(np.array(faces), np.array(lengths), np.array(names))


def needle_torus(angle):
    """Six triangles with this angle between equal sides, whose linear functions bound next to nothing."""
    sides = 2 * np.sin(np.radians(angle) / 2), 1, 1
    faces = [[0, 1, 2]] * 3 + [[2, 1, 0]] * 3
    names = [[1, 2, 0], [4, 5, 3], [7, 8, 6], [6, 2, 4], [0, 5, 7], [3, 8, 1]]
    return Surface.from_edge_lengths(np.array(faces), np.array([sides] * 3 + [sides[::-1]] * 3), np.array(names))


@pytest.mark.parametrize("angle", [0.1, 0.12, 0.15, 0.2])
def test_wide_bounds_are_not_taken_for_rounding(angle):
    structure = conformal_structure(needle_torus(angle), bounds=1e-8)
    assert structure.refinement.levels[1][1] > 10  # what is lost is at most 2
    assert structure.refinement.reached and structure.certificate.relative_width <= 1e-8


@pytest.mark.parametrize("seed", range(12))
def test_needles_of_any_width_have_true_reasons(seed):
    """The lattice of a flat torus is exact, and rounding alone keeps its bounds apart."""
    random = np.random.default_rng(seed)
    tau = complex(random.uniform(-0.5, 0.5), random.uniform(0.6, 2))
    thin, bounds = 10 ** random.uniform(-6, -1), 10.0 ** -(3 + seed % 8)
    weights = [thin, 0.4 * (1 - thin), 0.6 * (1 - thin)] if seed % 2 else [1 - 2 * thin, thin, thin]
    structure = conformal_structure(torus_with_inner_vertices(tau, weights), bounds=bounds)
    width = structure.certificate.relative_width
    found = conformally_equivalent(structure, [[tau]])
    assert found.verdict == "indistinguishable" and found.residual <= width
    assert structure.refinement.reached == (width <= bounds)
    if width > bounds:
        assert "rounding" in structure.refinement.reason and structure.certificate.rounding > bounds


def test_rounding_that_is_above_the_wish_is_told_at_once():
    refinement = conformal_structure(surface_of(GRADED["octagon"]), bounds=1e-13).refinement
    assert not refinement.reached and "rounding" in refinement.reason
    assert len(refinement.levels) == 2


@pytest.mark.parametrize("height", [1e-8, 1e-9, 0.0])
def test_what_has_no_bounds_has_none_as_narrow_as_asked_for(height):
    """A flat cap over the side from 0 to 1."""
    surface = torus_with_inner_vertices(0.3 + 1j, [0.5 - height, 0.5 - height, 2 * height])
    structure = conformal_structure(surface, bounds=1e-3)
    assert not structure.certificate.holds and not structure.refinement.reached
    assert not structure.refinement.has_bounds and "too thin" in structure.refinement.reason
