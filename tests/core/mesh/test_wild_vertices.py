"""Wild vertices, so far out that the rest of the mesh is rounding beside them: they are named, and left out with their
faces; the rest gets the map that it has by itself."""

import struct

import families
import numpy as np
import pytest
from command_runs import run
from holomorph import InvalidMesh, Surface, automatic_maps
from small_families import MESHES

FAMILIES = "torus of quads", "genus 1 block", "tetrahedron", "cylinder", "several", "ring of straight n-gons"
FAR = 1e12, 4.9e26, 1e200  # extents
DIRECTION = np.array([1.0, 0.3, -0.2])


def with_wild(mesh, vertices, far):
    points = mesh.vertices.copy()
    extent = np.ptp(points, axis=0).max()
    for number, vertex in enumerate(vertices):
        points[vertex] += (number + 1) * far * extent * np.roll(DIRECTION, number)
    return points


def faces_at(mesh, vertices):
    return [k for k, face in enumerate(np.split(mesh.corners, mesh.offsets[1:-1])) if set(face) & set(vertices)]


def without(mesh, faces):
    """The surface of the other faces."""
    rest = [face for k, face in enumerate(np.split(mesh.corners, mesh.offsets[1:-1])) if k not in faces]
    used, corners = np.unique(np.concatenate(rest), return_inverse=True)
    return Surface.from_polygons(mesh.vertices[used], corners, np.cumsum([0, *map(len, rest)]), strict=False)


@pytest.mark.parametrize("name", FAMILIES)
@pytest.mark.parametrize("far", FAR)
def test_the_rest_has_the_map_that_it_has_by_itself(name, far):
    mesh, vertex = MESHES[name], 2
    surface = Surface.from_polygons(with_wild(mesh, [vertex], far), mesh.corners, mesh.offsets, strict=False)
    (refused,) = surface.refused
    assert refused.faces.tolist() == faces_at(mesh, [vertex])
    assert f"vertex {vertex} " in refused.reason
    rest = without(mesh, refused.faces)
    for ours, theirs in zip(automatic_maps(surface), automatic_maps(rest), strict=True):
        assert ours.kind == theirs.kind and np.array_equal(ours.uv, theirs.uv)


@pytest.mark.parametrize("far", FAR)
def test_several_are_all_left_out(far):
    mesh, vertices = MESHES["torus of triangles"], [3, 40, 41, 77]
    surface = Surface.from_polygons(with_wild(mesh, vertices, far), mesh.corners, mesh.offsets, strict=False)
    assert surface.refused[0].faces.tolist() == faces_at(mesh, vertices)
    assert np.abs(surface.vertices).max() < 2 * np.abs(mesh.vertices).max()


def test_strictly_the_first_is_named():
    mesh = MESHES["torus of quads"]
    with pytest.raises(InvalidMesh, match="^vertex 5 is more than 1e9 times as far away as the mesh is large"):
        Surface.from_polygons(with_wild(mesh, [5, 9], 1e12), mesh.corners, mesh.offsets)


def test_beside_vertices_that_are_not_numbers():
    mesh = MESHES["torus of quads"]
    points = with_wild(mesh, [5], 1e12)
    points[50] = np.nan
    surface = Surface.from_polygons(points, mesh.corners, mesh.offsets, strict=False)
    assert [refused.faces.tolist() for refused in surface.refused] == [faces_at(mesh, [50]), faces_at(mesh, [5])]


@pytest.mark.parametrize("far", [1e3, 1e6, 1e12])
def test_a_part_that_is_far_away_as_a_whole_stays(far):
    torus = families.torus(12, 9)
    both = families.united(torus, torus)
    points = both.vertices.copy()
    points[len(torus.vertices) :] += far * DIRECTION
    assert not Surface.from_polygons(points, both.corners, both.offsets, strict=False).refused


@pytest.mark.parametrize("step", [2.0, 1e4, 1e7])
def test_a_mesh_that_grows_step_by_step_stays(step):
    """A fan that reaches out by one factor from row to row, up to 1e21."""
    sizes, rows = [step**k for k in range(4 if step > 10 else 60)], 6
    angles = np.arange(rows) * np.pi / 8
    points = np.array([[size * np.cos(a), size * np.sin(a), 0] for size in sizes for a in angles])
    first = np.array([i * rows + j for i in range(len(sizes) - 1) for j in range(rows - 1)])
    faces = np.stack([first, first + 1, first + rows + 1, first + rows], axis=1)
    assert not Surface(points, faces, strict=False).refused
    Surface(points, faces)


def test_nothing_is_wild_where_nothing_would_be_left():
    surface = Surface([[0, 0, 0], [1e-11, 1e-11, 0], [1, 0, 0]], [[0, 1, 2]], strict=False)
    assert not surface.refused


def test_a_vertex_of_no_face_may_be_anywhere():
    mesh = MESHES["torus of quads"]
    points = np.concatenate([mesh.vertices, [[1e30, 0, 0]]])
    assert not Surface.from_polygons(points, mesh.corners, mesh.offsets, strict=False).refused


def test_one_coordinate_of_a_file_of_triangles(tmp_path):
    """STL gives each face vertices of its own. The command maps the others, and says so."""
    mesh = families.torus(12, 9, shape="triangles")
    corners = mesh.vertices[mesh.corners].reshape(-1, 3, 3)
    corners[7, 1, 2] = 4.9e26
    records = [struct.pack("<12fH", 0, 0, 0, *triangle.ravel(), 0) for triangle in corners]
    path = tmp_path / "torus.stl"
    path.write_bytes(bytes(80) + struct.pack("<I", len(corners)) + b"".join(records))
    surface = Surface.read(path)
    assert [refused.faces.tolist() for refused in surface.refused] == [[7]]
    report = tmp_path / "report.json"
    done = run(path, "--output", tmp_path / "out.obj", "--report", report)
    assert done.returncode == 0, done.stderr
    assert "1 face left out" in report.read_text() and "times as far away" in report.read_text()
