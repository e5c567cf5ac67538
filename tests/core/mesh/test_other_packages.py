"""Surfaces of the meshes of other packages."""

from types import SimpleNamespace

import families
import numpy as np
import pytest
from holomorph import InvalidMesh, Surface
from holomorph.mesh.checked_mesh import given_polygons
from mesh_files import obj

TORUS = families.torus(8, 5, shape="triangles")
TRIANGLES = TORUS.corners.reshape(-1, 3)
POINTS = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0), (3, 0, 0), (1, 2, 0)]
POLYGONS = [(0, 1, 2, 3), (1, 4, 2), (0, 3, 5)]  # a quad, and triangles at two of its sides
PADDED = [number for polygon in POLYGONS for number in (len(polygon), *polygon)]


def block(kind, data):
    return SimpleNamespace(type=kind, data=np.array(data))


@pytest.mark.parametrize(
    "mesh",
    [
        SimpleNamespace(vertices=TORUS.vertices, faces=TRIANGLES),
        SimpleNamespace(vertices=TORUS.vertices, triangles=TRIANGLES),
        SimpleNamespace(points=TORUS.vertices, cells=[block("line", [[0, 1]]), block("triangle", TRIANGLES)]),
        SimpleNamespace(points=TORUS.vertices, faces=np.insert(TRIANGLES, 0, 3, axis=1).ravel()),
        Surface(TORUS.vertices, TRIANGLES),
    ],
    ids=["trimesh", "open3d", "meshio", "pyvista", "ours"],
)
def test_names_of_arrays_are_known(mesh):
    surface = Surface(mesh)
    assert np.array_equal(surface.vertices, TORUS.vertices) and np.array_equal(surface.triangles, TRIANGLES)


@pytest.mark.parametrize(
    "mesh",
    [
        SimpleNamespace(points=POINTS, cells=[block("quad", POLYGONS[:1]), block("triangle", POLYGONS[1:])]),
        SimpleNamespace(points=POINTS, faces=np.array(PADDED)),
    ],
    ids=["meshio", "pyvista"],
)
def test_polygons_stay_polygons(mesh):
    surface = Surface(mesh)
    assert surface.face_offsets.tolist() == [0, 4, 7, 10]
    assert surface.corner_vertices.tolist() == [vertex for polygon in POLYGONS for vertex in polygon]


def test_strips_are_triangles():
    """As PyVista has them beside its polygons: every other one runs the other way, and one of two corners is none."""
    strips = np.array([4, 0, 1, 3, 2, 4, 1, 1, 4, 2])
    _, corners, offsets = given_polygons(SimpleNamespace(points=POINTS, faces=np.array([3, 0, 3, 5]), strips=strips))
    assert corners.reshape(-1, 3).tolist() == [[0, 3, 5], [0, 1, 3], [3, 1, 2], [4, 1, 2]]
    assert offsets.tolist() == [0, 3, 6, 9, 12]
    alone = Surface(SimpleNamespace(points=POINTS, faces=np.array([], int), strips=np.array([4, 0, 1, 3, 2])))
    assert alone.triangles.tolist() == [[0, 1, 3], [3, 1, 2]]


@pytest.mark.parametrize("size", [5, 6, 9])
def test_an_array_has_a_row_for_each_polygon(size):
    turn = 2 * np.pi * np.arange(size) / size
    points = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    assert Surface(points, np.arange(size)[None]).face_offsets.tolist() == [0, size]


class Undecided:
    """As an empty scene of trimesh: what it has cannot be computed."""

    @property
    def triangles(self):
        raise ValueError("need at least one array to concatenate")


@pytest.mark.parametrize("sizes", [[3], [4, 3, 5], [3] * 100 + [7], np.random.default_rng(3).integers(3, 9, 1000)])
def test_padded_faces_of_any_sizes(sizes):
    """Their vertices, all 3 or so, may be taken for sizes."""
    corners = np.random.default_rng(1).integers(0, 6, sum(sizes))
    ends = np.cumsum([0, *sizes])
    padded = np.concatenate([[size, *corners[a:b]] for size, a, b in zip(sizes, ends, ends[1:])])
    _, found, offsets = given_polygons(SimpleNamespace(points=np.zeros((6, 3)), faces=padded))
    assert np.array_equal(found, corners) and np.array_equal(offsets, ends)


@pytest.mark.parametrize(
    ("mesh", "told"),
    [
        (Undecided(), r"one Undecided is no mesh"),
        (np.zeros((3, 3)), r"one ndarray is no mesh: pass Surface\(vertices, faces\)"),
        (SimpleNamespace(points=POINTS), "an object with vertices and faces, points and cells"),
        (SimpleNamespace(points=POINTS, cells=[block("tetra", [[0, 1, 2, 3]])]), "its cells: tetra"),
        (SimpleNamespace(points=POINTS, cells=[]), "its cells: none"),
        (SimpleNamespace(points=POINTS, faces=np.array([3, 0, 1, 2, 4, 1])), "is not padded"),
        (SimpleNamespace(points=POINTS, faces=np.array([-3, 0, 1, 2])), "is not padded"),
        (SimpleNamespace(vertices=POINTS, faces=np.array([[0, 1, 77]])), "77"),
    ],
)
def test_other_objects_are_told_how(mesh, told):
    with pytest.raises(InvalidMesh, match=told):
        Surface(mesh)


def test_of_the_packages_themselves(tmp_path):
    path = tmp_path / "mesh.obj"
    path.write_bytes(obj(TORUS))
    expected = Surface.read(path)
    found = {}
    for name, read in (
        ("trimesh", lambda package: package.load(path, process=False)),
        ("meshio", lambda package: package.read(path)),
        ("pyvista", lambda package: package.read(path)),
    ):
        try:
            package = __import__(name)
        except ModuleNotFoundError:
            continue
        found[name] = Surface(read(package))
    assert found or pytest.skip("none of the packages is here")
    for surface in found.values():
        assert np.allclose(surface.vertices, expected.vertices) and np.array_equal(
            surface.triangles, expected.triangles
        )
