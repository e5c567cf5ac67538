"""Triangles of aspects up to 1e12: forms to what is promised, or an error, and bounds that hold."""

import re

import equivalence
import families
import numpy as np
import pytest
from holomorph import SolverError, Surface, conformal_structure
from thin_meshes import glued, layout, square_with

ROUNDING = 1e-13  # error of a flat surface's modulus, in any triangulation
SOLVERS = [{"solver": "direct"}, {"solver": "multigrid"}, {"solver": "direct", "boundary": "double_cover"}]
every_solver = pytest.mark.parametrize("options", SOLVERS, ids=lambda options: " ".join(options.values()))


def ring(width, m=3, **keywords):
    """A flat ribbon closed to a ring around 1: its modulus is its width."""
    grid, corners = layout(24, m, width, **keywords)
    return glued(grid[..., 0] % 24 * (m + 1) + grid[..., 1], corners)


def holds(bounds, value):
    lower, upper = bounds
    return lower - ROUNDING * value <= value <= upper + ROUNDING * value


# ---- rings ---------------------------------------------------------------------------------------------------------


@every_solver
@pytest.mark.parametrize("cut", ["random", "one way"])
@pytest.mark.parametrize("m", [1, 3])
@pytest.mark.parametrize("width", [1e-2, 1e-4, 1e-5, 1e-6, 1e-7])
def test_the_modulus_of_a_ring_of_right_triangles(width, m, cut, options):
    """Weights of a / b and b / a side by side, a / b up to 1e6."""
    structure = conformal_structure(ring(width, m, cut=cut), **options)
    assert abs(structure.modulus / width - 1) < ROUNDING
    assert holds(structure.modulus_bounds, width)
    assert np.ptp(structure.modulus_bounds) < 1e-14
    assert structure.solver.residual < 1e-7


@every_solver
@pytest.mark.parametrize("m", [1, 3])
@pytest.mark.parametrize("width", [1e-2, 1e-3, 1e-4, 1e-5, 1e-6])
def test_the_modulus_of_a_ring_of_obtuse_triangles(width, m, options):
    """Rounded lengths leave open the square of the aspect."""
    for seed in range(5):
        structure = conformal_structure(ring(width, m, jitter=1.0, seed=seed), **options)
        assert holds(structure.modulus_bounds, width)
        assert np.ptp(structure.modulus_bounds) < width * max(20 * ROUNDING, 3e-16 / width**2)


@every_solver
@pytest.mark.parametrize("width", [1e-8, 3e-9, 1e-9, 1e-10, 1e-11])
def test_what_cannot_be_solved_is_refused(width, options):
    """At 1e-8 the modulus was too large by a factor of 5.7, with a residual of 5e-15."""
    for seed in range(5):
        try:
            structure = conformal_structure(ring(width, seed=seed), **options)
        except SolverError as error:
            assert "unknowns" in str(error) or "rounding" in str(error)
            continue
        assert width > 1e-9
        assert abs(structure.modulus / width - 1) < 1e-9
        assert holds(structure.modulus_bounds, width)


@pytest.mark.parametrize("height", [1e-3, 1e-5, 1e-7])
def test_prisms(height):
    """In space."""
    mesh = families.cylinder(24, 3)
    vertices = mesh.vertices * [1, 1, height / np.ptp(mesh.vertices[:, 2])]
    structure = conformal_structure(Surface(vertices, mesh.corners.reshape(-1, 4)))
    modulus = height / (2 * 24 * np.sin(np.pi / 24))
    assert abs(structure.modulus / modulus - 1) < 1e-7
    assert holds(structure.modulus_bounds, modulus)


@pytest.mark.parametrize("solver", ["direct", "multigrid"])
@pytest.mark.parametrize("threads", [1, 2, 4])
def test_bits_do_not_depend_on_the_threads(solver, threads):
    surface = ring(1e-5, 40, jitter=0.5)
    one, other = (conformal_structure(surface, solver=solver, threads=k) for k in (1, threads))
    assert one.modulus_bounds == other.modulus_bounds
    assert one.natural_forms.tobytes() == other.natural_forms.tobytes()


# ---- needles -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("angle", [0.8, 1.0, 1.3, 1.5])
@pytest.mark.parametrize("length", [1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 2e-12, 1e-12])
def test_needles_in_a_square(length, angle):
    """At 1e-9 the bounds crossed by 2e-9, at 1e-12 by 1e-6."""
    _, square = square_with(lambda a, _: a + length * np.array([np.cos(angle), np.sin(angle), 0]))
    lower, upper = square.modulus_bounds
    assert lower - ROUNDING <= 1 <= upper + ROUNDING
    assert upper - lower < length  # the order of the error of interpolation


# ---- tori ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", ["direct", "multigrid"])
@pytest.mark.parametrize("thinnest", [1e-2, 1e-4, 1e-6, 1e-8])
def test_a_square_torus_with_a_thin_row(thinnest, solver):
    """Im tau is the inverse of an integer in every basis."""
    n, m = 12, 6
    grid, corners = layout(n, m, 1.0, straight=True)
    corners[..., 1] = np.append(np.linspace(0, 1 - thinnest, m), 1.0)[grid[..., 1]]
    torus = conformal_structure(glued(grid[..., 0] % n * m + grid[..., 1] % m, corners), solver=solver)
    omega = torus.period_matrix[0, 0]
    imaginary = 1 / np.rint(1 / omega.imag)
    assert equivalence.distance(torus.period_matrix, np.array([[1j]])) < ROUNDING / thinnest
    lower, upper = (bound[0, 0] for bound in torus.period_bounds)
    assert lower - ROUNDING <= imaginary <= upper + ROUNDING
    assert upper - lower < max(ROUNDING, 1e-15 / thinnest)


def test_bounds_of_forms_in_blocks():
    """Flat triangles of relative height 1e-5 to 1e-8 on a surface of genus 2, whose forms are not all there at once."""
    mesh = families.block_with_holes(2, refine=2, jitter=0.1)
    vertices, quads = mesh.vertices, mesh.corners.reshape(-1, 4)
    faces = families.cut_quads(quads)
    cut = np.arange(0, len(faces), 7)
    a, b, c = faces[cut].T
    height = np.logspace(-5, -8, len(cut))[:, None]
    middle = (1 - height) * (vertices[a] + vertices[b]) / 2 + height * vertices[c]
    new = len(vertices) + np.arange(len(cut))
    split = [
        np.delete(faces, cut, axis=0),
        np.stack([a, new, c], 1),
        np.stack([new, b, c], 1),
        np.stack([a, b, new], 1),
    ]
    surface = Surface(np.vstack([vertices, middle]), np.vstack(split))
    with pytest.raises(SolverError) as refusal:
        conformal_structure(surface, memory_limit=1)
    least = int(re.search(r"at least (\d+) bytes", str(refusal.value))[1])
    blocks, kept = (conformal_structure(surface, memory_limit=limit) for limit in (least, None))
    assert not blocks.memory.keeps_forms and kept.memory.keeps_forms
    for structure in (blocks, kept):
        lower, upper = structure.period_bounds
        assert np.linalg.eigvalsh(structure.period_matrix.imag - lower).min() > 0
        assert np.linalg.eigvalsh(upper - structure.period_matrix.imag).min() > 0
