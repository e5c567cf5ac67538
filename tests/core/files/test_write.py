"""Meshes with UVs written to files, by the package and by its command."""

import json

import families
import holomorph
import numpy as np
import pytest
from holomorph import InvalidMesh, Surface, automatic_structure, form_map
from holomorph.__main__ import main
from holomorph.tiling.request import EVENNESS
from mesh_files import obj
from solved import solved, surface_of

ENDINGS = (".obj", ".ply")


def obj_uv(path):
    """(#C, 2) UVs of the corners of an OBJ file."""
    rows = [line.split() for line in path.read_text().splitlines()]
    values = np.array([row[1:] for row in rows if row[0] == "vt"], float)
    places = [int(corner.split("/")[1]) - 1 for row in rows if row[0] == "f" for corner in row[1:]]
    return values[places]


@pytest.mark.parametrize("ending", ENDINGS)
def test_what_is_written_is_read_again(ending, tmp_path):
    surface = surface_of(families.washer(20))
    surface.write(tmp_path / f"mesh{ending}")
    again = Surface.read(tmp_path / f"mesh{ending}")
    for name in ("vertices", "corner_vertices", "face_offsets"):
        assert (getattr(again, name) == getattr(surface, name)).all()


def test_uvs_keep_their_digits_and_a_surface_with_them_its_shape(tmp_path):
    structure = solved("torus of quads")
    uv = structure.uv(structure.balanced_coefficients())
    for ending in ENDINGS:
        structure.surface.write(tmp_path / f"mesh{ending}", uv)
    assert obj_uv(tmp_path / "mesh.obj").tobytes() == uv.tobytes()
    points = Surface.read(tmp_path / "mesh.ply", weld=True)  # a vertex on a seam is there several times
    assert (points.genus, len(points.vertices)) == (1, len(structure.surface.vertices))


def test_gltf_has_the_uvs(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    uv = np.array([[0, 0], [1, 0], [0.25, 0.75]])
    Surface(np.eye(3), [[0, 1, 2]]).write(tmp_path / "triangle.glb", uv)
    (mesh,) = trimesh.load(tmp_path / "triangle.glb", process=False).geometry.values()
    order = [int(np.flatnonzero((mesh.vertices == point).all(axis=1))[0]) for point in np.eye(3)]
    assert (mesh.visual.uv[order] == uv).all()
    Surface(np.eye(3), [[0, 1, 2]]).write(tmp_path / "plain.glb")
    (mesh,) = trimesh.load(tmp_path / "plain.glb", process=False).geometry.values()
    assert len(mesh.faces) == 1


@pytest.mark.parametrize("name", ["mesh.txt", "mesh", "mesh.stl", "mesh.obj.gz"])
def test_other_endings_are_refused(name, tmp_path):
    with pytest.raises(ValueError, match=r"must end with \.obj, \.ply or \.glb"):
        surface_of(families.cube()).write(tmp_path / name)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("uv", [np.zeros((3, 2)), np.zeros((24, 3)), np.full((24, 2), np.nan), "map"])
def test_maps_that_do_not_fit_are_refused(uv, tmp_path):
    with pytest.raises(ValueError, match="uv"):
        surface_of(families.cube()).write(tmp_path / "cube.obj", uv)
    assert not list(tmp_path.iterdir())


def test_a_surface_without_positions_is_refused(tmp_path):
    double = holomorph.double_cover(surface_of(families.cylinder(8, 2)))
    with pytest.raises(InvalidMesh, match="without positions"):
        double.write(tmp_path / "double.obj")


# ---- the command ---------------------------------------------------------------------------------------------------


@pytest.fixture
def two_parts(tmp_path):
    path = tmp_path / "two.obj"
    path.write_bytes(obj(families.united(families.cube(), families.torus(9, 6))))
    return path


@pytest.mark.parametrize("ending", ENDINGS)
def test_command_writes_the_mesh_with_its_maps(ending, two_parts, tmp_path):
    out, report = tmp_path / f"out{ending}", tmp_path / "report.json"
    assert main([str(two_parts), "--output", str(out), "--report", str(report)]) == 0
    given, written = Surface.read(two_parts), Surface.read(out, weld=True)
    assert [part.genus for part in written.components] == [part.genus for part in given.components] == [0, 1]
    assert json.loads(report.read_text())["verdict"]["level"] in ("good", "fair")


def test_command_writes_the_balanced_maps_side_by_side(two_parts, tmp_path, capsys):
    assert main([str(two_parts), "--output", str(tmp_path / "out.obj"), "--main", "balanced", "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")
    uv, surface = obj_uv(tmp_path / "out.obj"), Surface.read(two_parts)
    assert (uv >= -1e-12).all() and (uv <= 1 + 1e-12).all()
    for part in surface.components:
        structure = automatic_structure(part)
        own, balanced = structure.quality(uv[part.corner_index]), form_map(part, structure, evenness=EVENNESS).quality
        np.testing.assert_allclose(own.angle, balanced.angle, rtol=1e-9)


def test_command_writes_no_mesh_where_no_part_has_a_map(tmp_path, capsys):
    path, out = tmp_path / "line.obj", tmp_path / "out.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    assert main([str(path), "--output", str(out)]) == 1
    assert "zero area" in capsys.readouterr().err
    assert not out.exists()
