"""Files for printers: closed as the mesh is, in millimetres, the same bytes on every run."""

import zipfile
from io import BytesIO
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest
from heights import DEPTH, dots
from holomorph import Surface
from holomorph.files import printing
from tiled_families import tiled

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
SINGLE = 1e-6


@pytest.fixture(scope="module")
def made():
    return tiled("torus without poles").relief(dots(), DEPTH, most_triangles=5000)


def model(content):
    with zipfile.ZipFile(BytesIO(content)) as archive:
        assert archive.namelist()[0] == "[Content_Types].xml"
        assert b"3D/3dmodel.model" in archive.read("_rels/.rels")
        return ElementTree.fromstring(archive.read("3D/3dmodel.model"))


def test_3mf_has_the_triangles_in_millimetres(made):
    root = model(printing.content("part.3mf", made))
    assert root.get("unit") == "millimeter"
    vertices = [[float(each.get(name)) for name in "xyz"] for each in root.iter(f"{CORE}vertex")]
    triangles = [[int(each.get(f"v{k}")) for k in (1, 2, 3)] for each in root.iter(f"{CORE}triangle")]
    assert np.allclose(vertices, made.vertices, rtol=1e-8, atol=1e-8)
    assert np.array_equal(triangles, made.triangles)
    (item,) = root.iter(f"{CORE}item")
    (thing,) = root.iter(f"{CORE}object")
    assert item.get("objectid") == thing.get("id")


@pytest.mark.parametrize("ending", ["stl", "obj"])
def test_what_is_written_is_read_again(ending, made, tmp_path):
    path = tmp_path / f"part.{ending}"
    path.write_bytes(printing.content(path, made))
    again = Surface.read(path, strict=True)
    assert (again.genus, again.boundary_count, len(again.triangles)) == (1, 0, len(made.triangles))
    assert np.allclose(again.vertices.mean(axis=0), made.vertices.mean(axis=0), atol=SINGLE)
    assert again.area == pytest.approx(Surface(made.vertices, made.triangles).area, rel=SINGLE)


@pytest.mark.parametrize("ending", ["3mf", "stl"])
def test_others_read_it(ending, made):
    trimesh = pytest.importorskip("trimesh")
    for needed in ("networkx", "lxml"):
        pytest.importorskip(needed)
    content = printing.content(f"part.{ending}", made)
    mesh = trimesh.load(BytesIO(content), file_type=ending, force="mesh")
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(made.volume, rel=1e-5)


@pytest.mark.parametrize("ending", sorted(printing.WRITERS))
def test_the_same_bytes_on_every_run(ending, made):
    assert printing.content(f"part.{ending}", made) == printing.content(f"other.{ending.upper()}", made)


@pytest.mark.parametrize("name", ["part.txt", "part", "part.glb", "part.stl.gz"])
def test_other_endings_are_refused(name, made):
    with pytest.raises(ValueError, match=r"must end with \.stl, \.3mf or \.obj"):
        printing.content(name, made)


FAR = np.array([5e5, 4.6e6, 100.0])


def test_far_from_the_origin_3mf_has_the_place_beside_the_points(made, tmp_path):
    far, path = SimpleNamespace(vertices=made.vertices + FAR, triangles=made.triangles), tmp_path / "far.3mf"
    path.write_bytes(printing.content(path, far))
    assert printing.rounding(path, far) == 0
    again = Surface.read(path)
    assert np.allclose(again.vertices.mean(axis=0), far.vertices.mean(axis=0), atol=1e-6)
    assert again.area == pytest.approx(Surface(made.vertices, made.triangles).area, rel=SINGLE)


@pytest.mark.parametrize(("ending", "is_rounded"), [("stl", True), ("STL", True), ("obj", False), ("3mf", False)])
def test_what_single_precision_moves_is_known(ending, is_rounded, made):
    far = SimpleNamespace(vertices=made.vertices + FAR)
    assert (printing.rounding(f"part.{ending}", far) > 0.01) == is_rounded
    assert printing.rounding(f"part.{ending}", made) == 0
