"""Islands: cuts along seams, and maps with a free boundary: rigid motions of flat surfaces (exact), convergence."""

import families
import numpy as np
import pytest
from boundaries import boundary_mask
from holomorph import FreeBoundaryMap, Surface, TopologyError, islands
from island_checks import ISOMETRIC, assert_same_faces, free, is_rigid, sides, stretches
from plane_meshes import flat, ring
from solved import surface_of

SECOND_ORDER, FIRST_ORDER = 3.0, 1.8  # least factors of an error from one level to the next, twice as fine


def seams_where(surface, chosen):
    """(#S, 2) those edges of the polygons that `chosen(ends)`, of (#E, 2) vertices, picks."""
    corners, offsets = surface.corner_vertices, surface.face_offsets
    following = np.arange(1, len(corners) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    ends = np.unique(np.sort(np.stack([corners, corners[following]], axis=1), axis=1), axis=0)
    return ends[chosen(ends)]


def between(surface, inside):
    """Edges both ends of which are among the (#V,) bools."""
    return seams_where(surface, lambda ends: inside[ends].all(axis=1))


# ---- free boundaries ---------------------------------------------------------------------------------------------


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
    (part,) = islands(surface, [between(surface, np.isin(np.arange(24), [0, 1]))[0]])
    structure = free(part)
    assert structure.solver.name == "none"
    assert is_rigid(part)


def test_a_cylinder_cut_open_is_unrolled_rigidly():
    surface = surface_of(families.cylinder(24, 9))
    seam = between(surface, np.arange(len(surface.vertices)) < 9)
    (part,) = islands(surface, seam)
    assert (part.genus, part.boundary_count) == (0, 1)
    assert is_rigid(part)


def test_a_cone_cut_to_its_apex_becomes_a_sector():
    n, m = 20, 6
    surface = surface_of(cone(n, m))
    generator = np.isin(np.arange(1 + n * m), [0, *range(1, n * m, n)])
    (part,) = islands(surface, between(surface, generator))
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


# ---- cuts --------------------------------------------------------------------------------------------------------


def test_a_cube_falls_into_its_sides():
    surface = surface_of(families.cube())
    parts = islands(surface, seams_where(surface, lambda ends: np.ones(len(ends), bool)))
    assert len(parts) == 6
    assert_same_faces(surface, parts)
    assert all(is_rigid(part) for part in parts)


def test_a_torus_is_cut_to_a_disk():
    n, m = 12, 9
    surface = surface_of(families.torus(n, m))
    row, column = np.divmod(np.arange(n * m), m)
    seams = np.concatenate([between(surface, row == 0), between(surface, column == 0)])
    (part,) = islands(surface, seams)
    assert (part.genus, part.boundary_count) == (0, 1)
    assert len(part.vertices) == (n + 1) * (m + 1)
    assert_same_faces(surface, [part])


def test_without_seams_there_are_the_components():
    surface = surface_of(families.united(families.cube(), families.hemisphere(3)))
    parts = islands(surface, [])
    assert [len(part.vertices) for part in parts] == [len(part.vertices) for part in surface.components]
    assert_same_faces(surface, parts)


def test_a_slit_makes_a_hole():
    surface = surface_of(flat(4, jitter=0))
    on_axis = between(surface, (np.abs(surface.vertices[:, 1]) < 1e-9) & (np.abs(surface.vertices[:, 0]) < 0.6))
    (part,) = islands(surface, on_axis)
    assert part.boundary_count == 2
    assert len(part.vertices) == len(surface.vertices) + len(on_axis) - 1


def test_a_single_edge_inside_opens_nothing():
    surface = surface_of(flat(3))
    (part,) = islands(surface, [surface.triangles[0, :2]])
    assert np.array_equal(part.vertices, surface.vertices)


def test_reversed_faces_are_cut_alike():
    mesh = families.torus(12, 9)
    row, column = np.divmod(np.arange(12 * 9), 9)
    surfaces = [surface_of(mesh), surface_of(families.partly_reversed(mesh))]
    seams = np.concatenate([between(surfaces[0], row == 0), between(surfaces[0], column == 0)])
    for surface in surfaces:
        (part,) = islands(surface, seams)
        assert (part.genus, part.boundary_count) == (0, 1)


def test_vertices_are_those_of_the_mesh_as_given():
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 1, 0], [2, 2, 0], [1, 2, 0]]
    surface = Surface(square, [[0, 1, 2, 3], [2, 4, 5, 6]], strict=False)  # two fans touch at vertex 2
    assert not surface.is_whole
    parts = islands(surface, [[2, 3]])
    assert [sorted(part.vertex_index) for part in parts] == [[0, 1, 2, 3], [2, 4, 5, 6]]


@pytest.mark.parametrize(
    ("seams", "words"),
    [
        ([[0, 6]], "between the vertices 0 and 6, which no edge of a face joins"),
        ([[0, 8]], "vertices 0 and 8"),
        ([[-1, 0]], "vertices -1 and 0"),
        ([0, 1], r"\(rows, 2\) integers are needed"),
        ([[0.0, 1.0]], "integers are needed"),
    ],
)
def test_seams_that_are_none(seams, words):
    surface = surface_of(families.cube())
    with pytest.raises(TopologyError, match=words):
        islands(surface, seams)


def test_seams_that_are_none_may_be_passed_over():
    surface = surface_of(families.cube())
    assert len(islands(surface, [[0, 6], [0, 8], [-1, 0]], strict=False)) == 1


def test_intrinsic_surfaces_have_no_islands():
    with pytest.raises(TopologyError, match="edge lengths only"):
        islands(Surface.from_edge_lengths([[0, 1, 2]], [[1.0, 1.0, 1.0]]), [])


def test_rings_stay_rings():
    surface = surface_of(ring(4))
    (part,) = islands(surface, [])
    assert part.boundary_count == 2
