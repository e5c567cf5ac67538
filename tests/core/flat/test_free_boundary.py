"""Maps with a free boundary: rigid motions of flat surfaces (exact), convergence."""

import families
import numpy as np
import pytest
from boundaries import boundary_mask
from holomorph import FreeBoundaryMap, TopologyError
from holomorph.mesh.edges import polygon_sides
from island_checks import ISOMETRIC, cut_along, free, is_rigid, sides, stretches
from plane_meshes import flat
from solved import surface_of

SECOND_ORDER, FIRST_ORDER = 3.0, 1.8  # least factors of an error from one level to the next, twice as fine


def between(surface, inside):
    """(#S, 2) edges of polygons both ends of which are among the (#V,) bools."""
    ends = np.unique(np.sort(polygon_sides(surface), axis=1), axis=0)
    return ends[inside[ends].all(axis=1)]


def cone(n, m, angle=2.0):
    """A cone around an apex, vertex 0, with m rings of n vertices; vertex 1 + n i + j is on generator j."""
    turn = 2 * np.pi * np.arange(n) / n
    radius = np.sin(angle / 2)
    around = np.stack([radius * np.cos(turn), radius * np.sin(turn), np.full(n, -np.cos(angle / 2))], axis=1)
    points = np.concatenate([np.zeros((1, 3)), *(around * i / m for i in range(1, m + 1))])
    faces = [[0, 1 + j, 1 + (j + 1) % n] for j in range(n)]
    for i in range(m - 1):
        a = 1 + n * i
        faces += [[a + j, a + n + j, a + n + (j + 1) % n, a + (j + 1) % n] for j in range(n)]
    return families.polygons(points, faces, ((0, 1),))


def test_a_flat_disk_is_moved_rigidly():
    mesh = families.moved(flat(8), scale=3e4)
    assert is_rigid(surface_of(mesh))


def test_a_flat_shape_with_reflex_corners_is_moved_rigidly():
    cells = np.ones((6, 5), bool)
    cells[2:4, 1:] = cells[4:, 4] = False
    assert is_rigid(surface_of(families.flat_cells(cells, 1.0, jitter=0.2, topology=((0, 1),))))


def test_a_strip_without_inner_vertices_is_unrolled_rigidly():
    surface = surface_of(families.cylinder(12, 2))
    (part,) = cut_along(surface, [between(surface, np.isin(np.arange(24), [0, 1]))[0]])
    structure = free(part)
    assert structure.solver.name == "none"
    assert is_rigid(part)


def test_a_cylinder_cut_open_is_unrolled_rigidly():
    surface = surface_of(families.cylinder(24, 9))
    seam = between(surface, np.arange(len(surface.vertices)) < 9)
    (part,) = cut_along(surface, seam)
    assert (part.genus, part.boundary_count) == (0, 1)
    assert is_rigid(part)


def test_a_cone_cut_to_its_apex_becomes_a_sector():
    n, m = 20, 6
    surface = surface_of(cone(n, m))
    generator = np.isin(np.arange(1 + n * m), [0, *range(1, n * m, n)])
    (part,) = cut_along(surface, between(surface, generator))
    assert is_rigid(part)
    assert not is_rigid(surface)  # with the apex inside


def hemisphere_errors(n):
    """Errors against the stereographic map, whose scale factor is 1 / (1 + z): that of e^u, and of angles."""
    surface = surface_of(families.hemisphere(n))
    structure = free(surface)
    error = np.abs(structure.scale_factors - 1 / (1 + surface.vertices[:, 2])).max()
    return error, structure.quality(structure.uv()).mean_angle - 1


def test_a_hemisphere_converges_to_its_stereographic_map():
    coarse, fine = hemisphere_errors(12), hemisphere_errors(24)
    assert coarse[0] > SECOND_ORDER * fine[0]
    assert fine[0] < 2e-4
    assert coarse[1] > FIRST_ORDER * fine[1]  # as of every map of triangles
    assert fine[1] < 0.03


def test_lengths_are_kept_along_the_boundary():
    surface = surface_of(families.hemisphere(12))  # of so much symmetry that the curve is closed as it is
    structure, ends = free(surface), sides(surface)
    on_boundary = boundary_mask(surface)
    assert (structure.scale_factors[on_boundary] == 1).all()
    along = on_boundary[surface.corner_vertices[ends]].all(axis=1)
    assert np.abs(stretches(surface, structure.uv())[along] - 1).max() < ISOMETRIC


def test_the_map_does_not_depend_on_size_and_place():
    mesh = families.hemisphere(10, jitter=0.2)
    uv = free(surface_of(mesh)).uv()
    moved = free(surface_of(families.moved(mesh, scale=1e6))).uv()
    assert np.abs(moved / 1e6 - uv).max() < 1e-8


def test_a_mirror_image_has_the_mirrored_map():
    mesh = families.hemisphere(10, jitter=0.2)
    lengths = stretches(surface_of(mesh), free(surface_of(mesh)).uv())
    mirrored = surface_of(families.mirrored(mesh))
    assert np.abs(np.sort(stretches(mirrored, free(mirrored).uv())) - np.sort(lengths)).max() < 1e-8


def test_what_a_free_boundary_is_made_of():
    surface = surface_of(families.hemisphere(6))
    structure = free(surface)
    assert isinstance(structure, FreeBoundaryMap)
    assert "free boundary" in structure.description
    assert structure.invariants() == {}
    assert len(structure.seams) == len(structure.balanced_coefficients()) == 0


@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        (families.cylinder(8, 3), "2 boundaries; a free boundary needs a disk"),
        (families.cube(), "a free boundary needs a disk: cut it open along seams"),
    ],
)
def test_refusals_of_a_free_boundary(mesh, words):
    with pytest.raises(TopologyError, match=words):
        free(surface_of(mesh))
