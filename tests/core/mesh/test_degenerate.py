"""Degenerate geometry: coincident vertices, triangles without area, coordinates near the ends of doubles."""

import families
import numpy as np
import pytest
from holomorph import InvalidMesh, Surface, conformal_structure, log_map
from solved import surface_of
from thin_meshes import square_with


@pytest.mark.parametrize("cap", ["n-gon", "fan"])
@pytest.mark.parametrize("poles", [None, (0, 130)])
def test_spun_spheres_have_a_map_everywhere(cap, poles):
    """The vertices beside an automatic pole coincide with it."""
    structure = log_map(surface_of(families.spun(16, 8, cap)), poles)
    uv = structure.uv(structure.balanced_coefficients())
    assert np.isfinite(uv).all()
    quality = structure.quality(uv)
    assert not quality.flipped.any() and not quality.collapsed.any()
    assert quality.mean_angle < 1.3
    assert np.isfinite(structure.sphere_map()).all()


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_triangles_without_finite_uvs_are_no_good_ones(value):
    structure = conformal_structure(surface_of(families.torus(6, 6)))
    uv = structure.uv(structure.balanced_coefficients()).copy()
    uv[structure._triangulation.triangle_corners[5, 1]] = value
    quality = structure.quality(uv)
    bad = np.flatnonzero(
        (structure._triangulation.triangle_corners == structure._triangulation.triangle_corners[5, 1]).any(axis=1)
    )
    assert np.array_equal(np.flatnonzero(quality.collapsed), bad)
    assert np.isfinite(quality.mean_angle) and np.isfinite(quality.density_ratio) and not quality.flipped[bad].any()


def test_a_map_to_a_point_has_collapsed():
    structure = conformal_structure(surface_of(families.torus(6, 6)))
    quality = structure.quality(np.zeros((len(structure.surface.corner_vertices), 2)))
    assert quality.collapsed.all() and quality.mean_angle == pytest.approx(10) and np.isinf(quality.size_range)


def test_the_averaged_star_is_finite_where_triangles_have_no_area():
    structure = log_map(surface_of(families.spun(6, 4)))
    assert np.isfinite(structure.averaged_star(np.arange(len(structure.edges)))).all()


# ---- scale -------------------------------------------------------------------------------------------------


def results(structure):
    uv = structure.uv(structure.balanced_coefficients())
    return [structure.period_matrix, *structure.period_bounds, uv, structure.quality(uv).angle]


@pytest.mark.parametrize("exponent", [-190, -100, -40, 40, 100, 190])
def test_a_power_of_two_changes_no_bit(exponent):
    mesh = families.torus(12, 9, shape="triangles", jitter=0.2)
    faces = mesh.corners.reshape(-1, 3)
    scaled = conformal_structure(Surface(np.ldexp(mesh.vertices, exponent), faces))
    for ours, theirs in zip(results(scaled), results(conformal_structure(Surface(mesh.vertices, faces))), strict=True):
        assert np.array_equal(ours, theirs)


@pytest.mark.parametrize("size", [1e-300, 1e-150, 1e-61, 1e61, 1e154, 1e300, np.finfo(float).max / 2])
def test_sizes_beyond_what_products_allow_are_refused(size):
    mesh = families.torus(6, 5, shape="triangles")
    direction = "up" if size < 1 else "down"
    with pytest.raises(InvalidMesh, match=f"scale the mesh {direction}"):
        Surface(mesh.vertices / np.abs(mesh.vertices).max() * size, mesh.corners.reshape(-1, 3))
    faces, lengths = np.array([[0, 1, 2], [0, 2, 1]]), np.full((2, 3), size)
    with pytest.raises(InvalidMesh, match=f"scale (the lengths|them) {direction}"):
        Surface.from_edge_lengths(faces, lengths)


@pytest.mark.parametrize("size", [1e-59, 1e-70, 1e-74, 1e-80, 1e-150, 1e-300])
def test_a_corner_shrunk_to_next_to_nothing_does_no_harm(size):
    """Triangles whose products underflow count as degenerate."""
    mesh = families.torus(12, 9, shape="triangles", jitter=0.2)
    vertices, faces = mesh.vertices - mesh.vertices[40], mesh.corners.reshape(-1, 3)
    star = np.unique(faces[(faces == 40).any(axis=1)])
    vertices[star] *= size
    structure = conformal_structure(Surface(vertices, faces))
    shrunk = conformal_structure(Surface(np.where(np.abs(vertices) < 1e-58, 0, vertices), faces))
    difference = np.abs(structure.period_matrix - shrunk.period_matrix).max()
    assert difference < 1e-5 * np.abs(shrunk.period_matrix).max()


# ---- bounds ------------------------------------------------------------------------------------------------

ROUNDING = 1e-12
FLAT = 1e-8  # rounded lengths leave open where the middle vertex of a flat triangle is, to 1e-8 of its longest side


@pytest.mark.parametrize("height", [0, 1e-15, 1e-12, 1e-9, 1e-7, 3e-7])
@pytest.mark.parametrize("place", [0.5, 0.3, 0.01])
def test_flat_triangles_leave_the_metric_as_it_is(place, height):
    surface, square = square_with(lambda a, b: (1 - place) * a + place * b + [height, -height, 0])
    assert height >= 1e-7 or len(surface.repairs.zero_area_faces)
    lower, upper = square.modulus_bounds
    assert abs(square.modulus - 1) < ROUNDING and lower - ROUNDING <= 1 <= upper + ROUNDING
    assert upper - lower < FLAT


def test_another_surface_has_no_bounds():
    """Coincident vertices cannot be flipped away."""
    _, square = square_with(lambda a, _: a)
    assert square.modulus_bounds is None and square.invariants()["modulus_bounds"] is None
    assert abs(square.modulus - 1) < 1e-6
    mesh = families.torus(12, 9, shape="triangles")
    vertices, faces = mesh.vertices.copy(), mesh.corners.reshape(-1, 3)
    vertices[faces[50, 0]] = vertices[faces[50, 1]]
    structure = conformal_structure(Surface(vertices, faces))
    assert structure.period_bounds is None and structure.invariants()["period_bounds"] is None


def test_the_ring_of_an_annulus_without_length_has_no_bounds():
    mesh = families.cylinder(24, 5)
    vertices, faces = mesh.vertices.copy(), mesh.corners.reshape(-1, 4)
    vertices[faces[50, 0]] = vertices[faces[50, 1]]
    tube = conformal_structure(Surface(vertices, faces))
    assert tube.capacity_bounds is None and tube.modulus_bounds is None
    assert np.isfinite(tube.modulus)


# ---- few vertices ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", ["direct", "multigrid"])
def test_a_bounded_surface_of_two_vertices(solver):
    """Pinned at one of them, nothing connects what is left."""
    faces = np.array([[0, 0, 0], [0, 0, 0], [1, 0, 1], [1, 0, 0], [0, 0, 0], [0, 0, 1], [0, 1, 0], [1, 0, 1]])
    names = [7, 8, 3, 4, 2, 11, 9, 12, 10, 3, 5, 1, 11, 7, 8, 10, 9, 4, 6, 2, 0, 6, 12, 5]
    edges = np.array(names).reshape(-1, 3)
    surface = Surface.from_edge_lengths(faces, np.ones(faces.shape), edges)
    assert (surface.genus, surface.boundary_count, len(surface.vertex_index)) == (2, 1, 2)
    structure = conformal_structure(surface, solver=solver)
    assert np.linalg.eigvalsh(structure.period_matrix.imag).min() > 0
