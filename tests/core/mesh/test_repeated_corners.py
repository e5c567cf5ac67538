"""Corners that are one: written twice in a row, or at the ends of a side that is a point, as at the poles of a grid."""

from dataclasses import replace

import families
import numpy as np
import pytest
from holomorph import InvalidMesh, Surface, automatic_map
from holomorph.maps import arrangement
from mesh_files import obj, off, ply_text

TORUS = families.torus(8, 6, shape="triangles")
FAR = np.array([5e5, 4.6e6, 100.0])


def lenient(mesh):
    return Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets, strict=False)


def as_quads(mesh, places):
    """Triangles a b c as a b c c, a b b c, a a b c or a b c a, in turn."""
    ways = ([0, 1, 2, 2], [0, 1, 1, 2], [0, 0, 1, 2], [0, 1, 2, 0])
    faces = [face.tolist() for face in mesh.faces]
    return families.polygons(
        mesh.vertices, [[f[k] for k in ways[i % 4]] if i in places else f for i, f in enumerate(faces)]
    )


@pytest.mark.parametrize("places", [{7}, {0, 95}, set(range(96)), set(range(0, 96, 5))])
def test_triangles_that_are_written_as_quads(places):
    surface = lenient(as_quads(TORUS, places))
    assert len(surface.components) == 1 and (surface.genus, surface.boundary_count) == (1, 0)
    assert not surface.repairs.cuts and not surface.refused
    assert surface.face_index.tolist() == list(range(96)) and len(surface.triangles) == 96


def test_a_larger_polygon_keeps_its_other_corners():
    points = np.exp(2j * np.pi * np.arange(5) / 5)
    mesh = families.polygons(
        np.column_stack([points.real, points.imag, 0 * points.real]), [[1, 1, 1, 2, 3, 3, 4, 0, 0]]
    )
    surface = lenient(mesh)
    assert surface.corner_vertices.tolist() == [1, 2, 3, 4, 0] and surface.boundary_count == 1


@pytest.mark.parametrize("name", ["mesh.obj", "mesh.off", "mesh.ply"])
def test_files_of_such_quads(name, tmp_path):
    mesh, path = as_quads(TORUS, set(range(96))), tmp_path / name
    path.write_bytes({"obj": obj, "off": off, "ply": ply_text}[name[-3:]](mesh))
    surface = Surface.read(path)
    assert (surface.genus, surface.boundary_count) == (1, 0)
    with pytest.raises(InvalidMesh, match="twice"):
        Surface.read(path, strict=True)


def test_both_corners_have_the_uv_of_one():
    mesh = as_quads(TORUS, set(range(96)))
    surface = lenient(mesh)
    made = automatic_map(surface)
    uv = arrangement.arranged([made], len(mesh.corners)).reshape(-1, 4, 2)
    vertices = mesh.corners.reshape(-1, 4)
    for k in range(4):
        same = vertices[:, k] == vertices[:, k - 1]
        assert np.array_equal(uv[same, k], uv[same, k - 1])
    assert (np.abs(uv).max(axis=(1, 2)) > 0).all()


# ---- sides that are points -------------------------------------------------------------------------------------------


def grid(n, m, place, shape):
    """(n + 1) x (m + 1) places in rows, of which both ends may be one: every place has a vertex of its own."""
    rows = [[i * (m + 1) + j, (i + 1) * (m + 1) + j, (i + 1) * (m + 1) + j + 1, i * (m + 1) + j + 1]
            for i in range(n) for j in range(m)]  # fmt: skip
    faces = rows if shape == "quads" else [half for a, b, c, d in rows for half in ([a, b, c], [a, c, d])]
    points = [place(i / n, j / m) for i in range(n + 1) for j in range(m + 1)]
    return families.polygons(np.array(points), faces)


def ball(s, t):
    return np.sin(np.pi * s) * np.cos(2 * np.pi * t), np.sin(np.pi * s) * np.sin(2 * np.pi * t), np.cos(np.pi * s)


def spindle(s, t):
    return s * (1 - s) * np.cos(2 * np.pi * t), s * (1 - s) * np.sin(2 * np.pi * t), 3 * s


def cone(s, t):
    return s * np.cos(2 * np.pi * t), s * np.sin(2 * np.pi * t), s


def half_ball(s, t):
    return ball(s, t / 2)


@pytest.mark.parametrize("shape", ["quads", "triangles"])
@pytest.mark.parametrize("far", [0 * FAR, FAR], ids=["near", "far"])
@pytest.mark.parametrize(("place", "boundary"), [(ball, 0), (spindle, 0), (cone, 1), (half_ball, 1)])
def test_rows_at_one_place_are_a_vertex(place, boundary, far, shape):
    """The sines and cosines of the ends differ by rounding."""
    mesh = grid(10, 14, place, shape)
    mesh = replace(mesh, vertices=mesh.vertices + far)
    surface = lenient(mesh)
    assert len(surface.components) == 1 and (surface.genus, surface.boundary_count) == (0, boundary)
    gone = surface.repairs.zero_area_faces
    assert not surface.refused
    assert np.array_equal(np.sort(np.concatenate([surface.face_index, gone])), np.arange(mesh.face_count))
    assert len(gone) == (0 if shape == "quads" else 14 if place is cone else 28)
    copies = np.concatenate([surface.vertex_index, surface.repairs.joined_vertices])
    assert np.array_equal(np.unique(copies), np.arange(len(mesh.vertices)))


def test_a_side_without_length_between_two_faces_stays():
    """Only the rim of a hole can be a point."""
    cube = families.cube()
    points = cube.vertices.copy()
    points[cube.faces[0][1]] = points[cube.faces[0][0]]
    surface = lenient(replace(cube, vertices=points))
    assert surface.is_whole and len(surface.vertices) == 8


def test_nothing_but_points_is_refused():
    with pytest.raises(InvalidMesh, match="area"):
        lenient(families.polygons(np.zeros((3, 3)) + [1, 2, 3], [[0, 1, 2]]))
