"""The distortion of any UV map of any polygons."""

from types import SimpleNamespace

import holomorph
import numpy as np
import pytest
from families import torus
from holomorph import coarse_places, distortion
from holomorph.maps.report import part_report
from holomorph.mesh.edges import boundary_edges
from plane_meshes import grid
from solved import surface_of


def of_arrays(vertices, faces, at):
    offsets = np.concatenate([[0], np.cumsum([len(f) for f in faces])])
    mesh = SimpleNamespace(
        vertices=np.asarray(vertices, float), corner_vertices=np.concatenate(faces), face_offsets=offsets
    )
    return distortion.measure(mesh, np.asarray(at, float))


def test_triangles_have_the_quality_of_the_structure():
    surface = surface_of(torus(24, 12, shape="triangles"))
    structure = holomorph.conformal_structure(surface)
    at = structure.uv(structure.balanced_coefficients()) * (1.0, 1.4)
    expected, found = structure.quality(at), distortion.measure(surface, at)
    assert np.allclose(found.angle, expected.angle, rtol=1e-9)
    assert np.allclose(2**found.density, expected.area / expected.median_density, rtol=1e-9)
    assert found.mean_angle == pytest.approx(expected.mean_angle, rel=1e-9)
    assert found.size_range == pytest.approx(expected.size_range, rel=1e-9)


def row_of_squares(*shapes):
    """Unit squares side by side, and their UVs."""
    count = len(shapes)
    below = np.array([(i, 0, 0) for i in range(count + 1)])
    faces = [(i, i + 1, i + count + 2, i + count + 1) for i in range(count)]
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    mesh = SimpleNamespace(
        vertices=np.concatenate([below, below + (0, 1, 0)]).astype(float),
        corner_vertices=np.concatenate(faces),
        face_offsets=np.arange(count + 1) * 4,
    )
    return mesh, np.concatenate([square * shape for shape in shapes])


def test_the_worst_places_are_named():
    mesh, uv = row_of_squares(1, 1, 1, 1, 0.5, 2, (3, 1 / 3), 1, 8)
    found = distortion.worst_places(mesh, uv, poles=np.array([9]))  # at the last square
    assert {name: place.face for name, place in found.items()} == {"largest": 4, "smallest": 5, "sheared": 6}
    assert found["largest"].value == pytest.approx(2) and found["smallest"].value == pytest.approx(0.5)
    assert found["sheared"].value == pytest.approx(9) and found["sheared"].position == pytest.approx((6.5, 0.5, 0))
    assert distortion.worst_places(mesh, uv, poles=np.arange(20)) == {}


def test_a_map_names_its_worst_places():
    made = holomorph.automatic_map(surface_of(torus(24, 12)), main="balanced")
    worst = made.worst_places
    assert worst["largest"].value >= 1 >= worst["smallest"].value and worst["sheared"].value >= 1
    told = part_report(made)["main_map"]["worst_places"]
    assert told["sheared"]["face"] == worst["sheared"].face


def test_density_is_in_octaves_of_the_median():
    vertices, quads = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)]), []
    vertices = np.concatenate([vertices, vertices + (0, 1, 0)])
    quads = [(i, i + 1, i + 5, i + 4) for i in range(3)]
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    found = of_arrays(vertices, quads, np.concatenate([square, 4 * square, square / 2]))
    assert np.allclose(found.density, [0, 4, -2])
    assert found.size_range == pytest.approx(8)


def test_degenerate_faces_and_maps_give_finite_numbers():
    vertices = [(0, 0, 0), (1, 0, 0), (0, 2, 0), (2, 0, 0), (1, 1, 0)]
    faces = [(0, 1, 2), (0, 1, 3), (1, 4, 2)]
    at = [(0, 0), (1, 0), (0, 2), (0, 0), (1, 0), (2, 1), (1, 0), (1, 0), (1, 0)]
    found = of_arrays(vertices, faces, at)
    assert found.angle.tolist() == [1, 1, distortion.COLLAPSED]
    assert found.density[1] == 0 and found.density[2] == -distortion.MOST_OCTAVES
    assert found.mean_angle == pytest.approx((1 + 0.5 * 10) / 1.5)
    nothing = of_arrays(vertices, faces, np.zeros((9, 2)))
    assert np.isfinite(nothing.angle).all() and np.isfinite(nothing.density).all()


@pytest.mark.parametrize(
    ("wrong", "error"),
    [
        ({"vertices": np.zeros((3, 2))}, ValueError),
        ({"corner_vertices": np.array([0, 1, 3])}, IndexError),
        ({"corner_vertices": np.array([0, 1, -1])}, IndexError),
        ({"corner_vertices": np.array([0, 1])}, ValueError),
        ({"face_offsets": np.array([0, 4])}, IndexError),
        ({"face_offsets": np.array([0, 3, 0, 3])}, IndexError),
        ({"face_offsets": np.array([], int)}, IndexError),
    ],
)
def test_arrays_that_are_no_mesh_are_refused(wrong, error):
    mesh = {"vertices": np.eye(3), "corner_vertices": np.arange(3), "face_offsets": np.array([0, 3])}
    for measure in (distortion.measure, distortion.drawn_density):
        measure(SimpleNamespace(**mesh), np.eye(3)[:, :2])
        with pytest.raises(error):
            measure(SimpleNamespace(**mesh | wrong), np.eye(3)[:, :2])


def test_fans_cover_each_polygon():
    """Seven corners of a regular heptagon, a quad and a triangle: areas add up."""
    turn = 2 * np.pi * np.arange(7) / 7
    vertices = np.concatenate([np.stack([np.cos(turn), np.sin(turn)], 1), [(5, 0), (6, 0), (6, 1), (5, 1)]])
    corner_vertices = np.array([0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 7, 8, 9])
    corners, polygon = distortion.fans(np.array([0, 7, 11, 14]))
    a, b, c = vertices[corner_vertices[corners]].transpose(1, 0, 2)
    areas = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    assert np.allclose(np.bincount(polygon, areas), [3.5 * np.sin(2 * np.pi / 7), 1, 0.5])


def test_lengths_are_those_of_the_map():
    surface = surface_of(torus(24, 12))
    at = surface.vertices[surface.corner_vertices][:, :2]
    one = distortion.length_ratio(surface, at)
    assert distortion.length_ratio(surface, 3 * at) == pytest.approx(3 * one, rel=1e-12)
    assert distortion.length_ratio(surface, 0 * at) == 0


# ---- coarse places -----------------------------------------------------------------------------------------------

SIDE = 8  # quads of a square sheet, on each side
SHEET = surface_of(grid(SIDE, SIDE))


def density_with(faces, octaves=-6.0):
    """0 but on the faces at these (column, row)."""
    density = np.zeros(SIDE * SIDE)
    density[[SIDE * column + row for column, row in faces]] = octaves
    return density


def test_coarse_faces_that_hang_together_are_a_place():
    """Also where they share a vertex alone; the largest first, and the coarsest face says where it is."""
    density = density_with([(1, 1), (2, 2), (2, 3), (6, 6), (6, 5)])
    density[SIDE * 2 + 3] = -8
    large, small = coarse_places(SHEET, density)
    assert large.times == pytest.approx(2 ** (20 / 6)) and small.times == pytest.approx(8)
    assert large.vertex in SHEET.corner_vertices.reshape(-1, 4)[SIDE * 2 + 3]


def test_places_have_a_vertex_off_the_boundary():
    inner = np.setdiff1d(SHEET.corner_vertices, boundary_edges(SHEET))
    for faces in ([(0, 0)], [(0, 3), (0, 4)], [(7, 7), (6, 7)]):
        (place,) = coarse_places(SHEET, density_with(faces))
        assert place.vertex in inner
    strip = surface_of(grid(SIDE * SIDE, 1))  # all its vertices are on the boundary
    assert coarse_places(strip, density_with([(3, 3)])) == []


def test_few_and_hardly_coarse_faces_are_no_place():
    assert coarse_places(SHEET, density_with([(3, 3)], octaves=-3.9)) == []
    wide = surface_of(grid(40, 40))
    density = np.zeros(1600)
    density[[820, 821]] = -6  # below 0.2 % of all faces
    assert coarse_places(wide, density) == []
