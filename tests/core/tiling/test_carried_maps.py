"""Maps that turn, made on a level and carried to all triangles: jumps, cones and faces as on a small mesh."""

import families
import numpy as np
import pytest
from holomorph import Surface, automatic_structure
from solved import surface_of
from turned_jumps import jump_errors


def quad_torus(n, m):
    """With waves, of n x m quads."""
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    a, b = 2 * np.pi * i / n, 2 * np.pi * j / m
    r = 2 + np.cos(b) * (1 + 0.3 * np.sin(2 * a))
    points = np.stack([r * np.cos(a), r * np.sin(a), np.sin(b) * (1 + 0.3 * np.sin(3 * a))], axis=-1)
    number = i * m + j
    at = [np.roll(number, shift, (0, 1)) for shift in ((0, 0), (-1, 0), (-1, -1), (0, -1))]
    return Surface(points.reshape(-1, 3), np.stack([each.ravel() for each in at], axis=1))


# All have more triangles than the level.
MESHES = {
    "ball": lambda: surface_of(families.geodesic_sphere(24)),
    "quads": lambda: quad_torus(96, 64),
    "block": lambda: surface_of(families.block_with_holes(2, refine=12, jitter=0.2)),
    "bowl": lambda: surface_of(families.hemisphere(44)),
    "tube": lambda: surface_of(families.cylinder(64, 96)),
    "torus with a hole": lambda: surface_of(families.punctured_torus(84, 72)),
}


def tiling(surface, turns, **options):
    return automatic_structure(surface).tile(300.0, turns=turns, **options)


@pytest.fixture(scope="module", params=MESHES)
def surface(request):
    result = MESHES[request.param]()
    assert len(result.triangles) > 10_500
    return result


@pytest.mark.parametrize("turns", [2, 4, 6])
def test_jumps_and_angles_are_exact(surface, turns):
    """Every vertex that is no cone, nor on the boundary, has one full turn around it."""
    made = tiling(surface, turns, evenness=0.5)
    error = jump_errors(surface, made)
    assert error.max() == 0 if turns != 6 else error.max() < 1e-12
    wanted = np.ones(len(surface.vertices))
    wanted[made.cones] = made.cone_angles
    at, ends = (made.uv @ [1, 1j])[surface.triangle_corners], surface.triangles
    angles = np.angle((np.roll(at, 1, axis=1) - at) / (np.roll(at, -1, axis=1) - at)) / (2 * np.pi)
    edges, counts = np.unique(surface._native.triangle_edges, return_counts=True)
    is_rim = np.isin(surface._native.triangle_edges, edges[counts == 1])
    on_rim = np.union1d(ends[is_rim], np.roll(ends, -1, axis=1)[is_rim])
    inner = np.setdiff1d(np.arange(len(wanted)), on_rim)
    assert np.allclose(np.bincount(ends.ravel(), angles.ravel())[inner], wanted[inner], atol=1e-6)
    assert not made.quality.flipped.any()


def test_it_is_as_even_as_on_the_level(surface):
    made = tiling(surface, 4, evenness=0.5)
    rough = tiling(surface, 4, evenness=0.0)
    assert made.quality.size_range < rough.quality.size_range + 1e-4
    assert made.quality.mean_angle < 1.35 and made.quality.size_range < 1.7


def test_the_numbers_of_triangles_do_not_count():
    """A level is the same whatever the order of the mesh, and so is the map."""
    one = surface_of(families.geodesic_sphere(24))
    other = Surface(one.vertices, one.triangles[np.random.default_rng(5).permutation(len(one.triangles))])
    first, second = tiling(one, 4, evenness=0.5), tiling(other, 4, evenness=0.5)
    assert np.array_equal(np.sort(first.cones), np.sort(second.cones))
    assert second.quality.size_range == pytest.approx(first.quality.size_range, rel=1e-6)


def test_cones_that_are_chosen_are_vertices_of_the_level():
    ball = surface_of(families.geodesic_sphere(24))
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / np.sqrt(3)
    chosen = [int(np.argmin(np.linalg.norm(ball.vertices - corner, axis=1))) for corner in corners]
    made = automatic_structure(ball).tile(300.0, turns=4, cones=dict.fromkeys(chosen, 0.75))
    assert sorted(made.cones) == sorted(chosen) and np.allclose(made.cone_angles, 0.75)
    assert jump_errors(ball, made).max() == 0 and not made.quality.flipped.any()
