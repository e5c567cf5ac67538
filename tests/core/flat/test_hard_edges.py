"""Islands along hard edges: developable parts without distortion, cuts to tips, angles and scales."""

import families
import numpy as np
import pytest
from holomorph import Surface, free_boundary_map, islands, log_map
from island_checks import assert_same_faces, is_rigid
from solids import bracket, can, cone
from solved import surface_of

ANGLE = 40  # degrees


def test_a_cone_is_too_coarse_for_one_map_and_fits_in_islands():
    surface = cone()
    structure = log_map(surface)
    whole = structure.quality(structure.uv(structure.balanced_coefficients()))
    assert whole.mean_angle > 3 and not whole.verdict.is_fit
    parts = islands(surface, hard_edges=ANGLE)
    assert [len(part.face_index) for part in parts] == [32, 1]
    assert_same_faces(surface, parts)
    assert all(is_rigid(part) for part in parts)


def test_the_cut_to_a_tip_is_one_edge_long():
    side = islands(cone(), hard_edges=ANGLE)[0]
    assert (side.genus, side.boundary_count) == (0, 1)
    assert np.count_nonzero(side.vertex_index == 32) == 1  # the tip stays one vertex
    assert len(side.vertices) == 32 + 1 + 1


def test_tips_inside_a_fine_mesh_are_reached_by_the_shortest_path():
    """A pyramid on a plate, in small cells: the plate's rim is the only seam."""
    n = 24
    x, y = np.divmod(np.arange((n + 1) ** 2), n + 1)
    height = np.maximum(0, 6 - np.maximum(abs(x - n // 2), abs(y - n // 2))) * 3.0
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    quads = np.stack([corner, corner + n + 1, corner + n + 2, corner + 1], axis=1)
    surface = Surface(np.stack([x, y, height], axis=1).astype(float), quads)
    (part,) = islands(surface, hard_edges=170)
    assert (part.genus, part.boundary_count) == (0, 1)
    assert len(part.vertices) > len(surface.vertices)
    before, after = (free_boundary_map(each) for each in (surface, part))
    uneven, even = (each.quality(each.uv()).density_ratio for each in (before, after))
    assert even < uneven


def test_a_can_falls_into_side_and_caps():
    parts = islands(can(), hard_edges=ANGLE)
    assert [(part.boundary_count, len(part.face_index)) for part in parts] == [(2, 32), (1, 1), (1, 1)]


def test_a_cube_falls_into_its_sides_at_angles_below_ninety():
    surface = surface_of(families.cube())
    assert [len(islands(surface, hard_edges=degrees)) for degrees in (89.9, 90.1)] == [6, 1]


def test_seams_count_besides():
    surface = can()
    parts = islands(surface, [[0, 32]], hard_edges=ANGLE)
    assert parts[0].boundary_count == 1 and is_rigid(parts[0])


def test_a_smooth_surface_has_no_hard_edges():
    surface = surface_of(families.geodesic_sphere(6))
    (part,) = islands(surface, hard_edges=ANGLE)
    assert part.boundary_count == 0 and len(part.vertices) == len(surface.vertices)


@pytest.mark.parametrize("change", [lambda m: families.moved(m, scale=1e-5), families.partly_reversed])
def test_size_place_and_the_order_of_corners_do_not_matter(change):
    mesh = families.cube()
    assert len(islands(surface_of(change(mesh)), hard_edges=ANGLE)) == 6


def test_open_edges_are_no_hard_edges():
    plate = surface_of(families.flat_cells(np.ones((3, 3), bool), 1.0, topology=((0, 1),)))
    assert len(islands(plate, hard_edges=1e-3)) == 1


@pytest.mark.parametrize("angle", [0, -1, np.nan, "40"])
def test_what_is_no_angle_is_refused(angle):
    with pytest.raises(ValueError, match="hard_edges is"):
        islands(can(), hard_edges=angle)


def test_a_bracket_is_flattened_without_shearing():
    """Plane parts; that with a hole is a ring, which is not flattened here."""
    parts = islands(bracket(), hard_edges=ANGLE)
    disks = [part for part in parts if part.boundary_count == 1]
    assert len(parts) - len(disks) == 2
    assert all(is_rigid(part) for part in disks)
