"""What a batch leaves: files that say the same as the library, a second run that does nothing, the summaries."""

import csv
import json
import math
import os
import sys

import holomorph
import numpy as np
import pytest
from batch_runs import BALANCED, outputs, run, torus_obj
from holomorph.batch import picture
from holomorph.files import formats, textures
from holomorph.tiling.request import EVENNESS

EVERYTHING = """
[maps]
main = "balanced"
forms = 1
[levels]
levels = 2
ratio = 0.5
[output]
formats = ["npz", "obj", "ply"]
"""


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """A torus with all its files; (source, folder of the asset)."""
    folder = tmp_path_factory.mktemp("done")
    source = torus_obj(folder / "torus.obj")
    (folder / "recipe.toml").write_text(EVERYTHING)
    result = run(source, "--out", folder / "out", "--recipe", folder / "recipe.toml")
    assert result.returncode == 0 and result.stdout.startswith("1 asset: 1 done; see "), result.stderr
    return source, folder / "out" / "assets" / "torus.obj"


def test_maps_are_those_of_the_library(done):
    """A closed part of genus 1 fills the UV square's height or width, with the library's angles. The main map is
    evened, that of a form is not."""
    source, folder = done
    surface = holomorph.Surface.read(source)
    structure = holomorph.conformal_structure(surface)
    arrays = np.load(folder / "mesh.npz")
    for name, evenness in (("uv", EVENNESS), ("uv_1", 0.0)):
        quality = structure.quality(arrays[name])
        expected = holomorph.form_map(surface, structure, evenness=evenness).quality
        assert quality.mean_angle == pytest.approx(expected.mean_angle, rel=1e-9)
        low, high = arrays[name].min(axis=0), arrays[name].max(axis=0)
        assert (high - low).max() == pytest.approx(1, rel=1e-9)
        assert (low + high) / 2 == pytest.approx([0.5, 0.5], abs=1e-9)
    report = json.loads((folder / "report.json").read_text())["components"][0]
    assert report["genus"] == 1 and report["done"]
    assert report["main_map"]["mean_angle"] == pytest.approx(structure.quality(arrays["uv"]).mean_angle, rel=1e-9)


def test_all_files_hold_the_same_mesh(done):
    source, folder = done
    surface, arrays = holomorph.Surface.read(source), np.load(folder / "mesh.npz")
    read = holomorph.Surface.read(folder / "mesh.obj")
    assert (read.vertices == surface.vertices).all()
    assert (read.corner_vertices == surface.corner_vertices).all()
    lines = (folder / "mesh.obj").read_text().splitlines()
    texture = np.array([line.split()[1:] for line in lines if line.startswith("vt ")], float)
    corners = [int(word.split("/")[1]) - 1 for line in lines if line.startswith("f ") for word in line.split()[1:]]
    assert (texture[corners] == arrays["uv"]).all()
    split = holomorph.Surface.read(folder / "mesh.ply")
    assert (split.vertices[split.corner_vertices] == surface.vertices[surface.corner_vertices]).all()


def test_levels(done):
    """Every vertex keeps its place."""
    _, folder = done
    fine = np.load(folder / "mesh.npz")
    for number, share in ((1, 0.5), (2, 0.25)):
        level = np.load(folder / f"lod{number}.npz")
        assert len(level["face_offsets"]) - 1 == pytest.approx(share * 2 * 24 * 12, abs=2)
        assert (level["vertices"] == fine["vertices"][level["vertex_index"]]).all()
        assert (folder / f"lod{number}.obj").exists() and (folder / f"lod{number}.ply").exists()


def test_gltf():
    trimesh = pytest.importorskip("trimesh")
    surface = holomorph.Surface(np.eye(3), [[0, 1, 2]])
    uv = np.array([[0, 0], [1, 0], [0.25, 0.75]])
    content = formats.glb(surface, uv)
    (mesh,) = trimesh.load(trimesh.util.wrap_as_stream(content), file_type="glb", process=False).geometry.values()
    order = [int(np.flatnonzero((mesh.vertices == point).all(axis=1))[0]) for point in surface.vertices]
    assert (mesh.visual.uv[order] == uv).all()
    assert formats.glb(surface, uv) == content


def test_one_texture_is_in_the_files_of_all_levels(tmp_path):
    """A checker that suits the finest one: from level to level it stays in place."""
    text = "[maps]\nmain = 'balanced'\n[levels]\nlevels = 1\n[output]\nformats = ['glb']\ntexture = 'checker'\n"
    (tmp_path / "recipe.toml").write_text(text)
    source = torus_obj(tmp_path / "torus.obj")
    result = run(source, "--out", tmp_path / "out", "--recipe", tmp_path / "recipe.toml")
    assert result.returncode == 0, result.stderr
    files = [tmp_path / "out/assets/torus.obj" / name for name in ("mesh.glb", "lod1.glb")]
    images = [path.read_bytes().partition(b"\x89PNG")[2] for path in files]
    assert images[0] and images[0] == images[1]


def test_a_picture_shows_what_is_in_front():
    """Two squares, the nearer one without a map: its grey covers the middle."""
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    towards = picture.VIEW / np.linalg.norm(picture.VIEW)
    right = np.cross([0, 1, 0], towards)
    right /= np.linalg.norm(right)
    plane = square[:, :1] * right + square[:, 1:] * np.cross(towards, right)
    points = np.concatenate([2 * plane, plane + towards])
    surface = holomorph.Surface(points, [[0, 1, 2, 3], [4, 5, 6, 7]])
    uv = np.concatenate([square, square]) / 4.0
    near = surface.triangle_faces == 1
    content = picture.png(surface, uv, ~near, "Y")
    colours = decoded(content)
    middle, corner = colours[picture.SIZE // 2, picture.SIZE // 2], colours[picture.SIZE // 8, picture.SIZE // 2]
    assert middle // picture.SHADES == 2 and corner // picture.SHADES in (0, 1)
    assert colours[0, 0] == picture.BACKGROUND
    assert content == picture.png(surface, uv, ~near, "Y")


def test_a_picture_of_a_map_that_turns_has_the_middle_of_a_square_at_whole_uvs():
    """About which a quarter turn leaves the checker."""
    square = holomorph.Surface(np.eye(4)[:, :3], [[0, 1, 2, 3]])
    uv, is_mapped = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) / 4.0, np.ones(2, bool)
    half = 0.5 / textures.squares(square, uv, is_mapped)
    assert picture.png(square, uv, is_mapped, "Y", True) == picture.png(square, uv + half, is_mapped, "Y")
    assert picture.png(square, uv, is_mapped, "Y", True) != picture.png(square, uv, is_mapped, "Y")


def decoded(content):
    import struct
    import zlib

    start = content.index(b"IDAT")
    (length,) = struct.unpack(">I", content[start - 4 : start])
    rows = np.frombuffer(zlib.decompress(content[start + 4 : start + 4 + length]), np.uint8)
    return rows.reshape(picture.SIZE, picture.SIZE + 1)[:, 1:]


def state(out):
    """All files of the assets: what they are and when they were written."""
    return {
        path: (path.stat().st_ino, path.stat().st_mtime_ns)
        for path in sorted((out / "assets").rglob("*"))
        if path.is_file()
    }


def test_a_second_run_does_nothing_and_a_change_is_done_alone(tmp_path):
    one, other = torus_obj(tmp_path / "one.obj"), torus_obj(tmp_path / "other.obj", 20)
    (tmp_path / "recipe.toml").write_text(BALANCED)
    arguments = (one, other, "--out", tmp_path / "out", "--recipe", tmp_path / "recipe.toml", "--workers", 1)
    assert run(*arguments).returncode == 0
    before, kept = state(tmp_path / "out"), outputs(tmp_path / "out")
    (tmp_path / "recipe.toml").write_text(BALANCED + "# the same\n")
    assert run(*arguments).returncode == 0
    assert state(tmp_path / "out") == before
    torus_obj(other, 28)
    assert run(*arguments).returncode == 0
    changed = {path.parent.name for path, entry in state(tmp_path / "out").items() if before.get(path) != entry}
    assert changed == {"other.obj"}
    torus_obj(other, 20)
    os.truncate(tmp_path / "out/assets/one.obj/mesh.npz", 0)  # as a failing disk leaves it
    assert run(*arguments).returncode == 0
    assert outputs(tmp_path / "out") == kept


def test_summaries(tmp_path):
    """A row for each part, one for what has none; CSV and Parquet say the same."""
    parquet = pytest.importorskip("pyarrow.parquet")
    source = tmp_path / "source"
    source.mkdir()
    text = torus_obj(source / "torus.obj").read_text()
    (source / "pair.obj").write_text(text + text.replace("f ", "# ") + shifted_faces(text))
    (source / "empty.obj").write_text("")
    (tmp_path / "recipe.toml").write_text(BALANCED)
    result = run(source, "--out", tmp_path / "out", "--recipe", tmp_path / "recipe.toml", "--workers", 1)
    assert result.returncode == 1 and "3 assets: 2 done, 1 refused" in result.stdout
    with open(tmp_path / "out/summary.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["name"], row["status"]) for row in rows] == [
        ("empty.obj", "refused"),
        ("pair.obj", "done"),
        ("pair.obj", "done"),
        ("torus.obj", "done"),
    ]
    assert {"residuals.closedness", "solver.name", "timings.total", "main_map.mean_angle"} <= set(rows[0])
    table = parquet.read_table(tmp_path / "out/summary.parquet").to_pylist()
    assert [row["name"] for row in table] == [row["name"] for row in rows]
    for one, other in zip(rows, table):
        angle = other["main_map.mean_angle"]
        assert one["main_map.mean_angle"] == ("" if angle is None else repr(angle))
        assert angle is None or math.isfinite(angle)


def shifted_faces(text):
    count = sum(line.startswith("v ") for line in text.splitlines())
    faces = [line.split()[1:] for line in text.splitlines() if line.startswith("f ")]
    return "".join("f " + " ".join(str(int(word) + count) for word in face) + "\n" for face in faces)


@pytest.mark.skipif(sys.platform != "linux", reason="a lock of the system")
def test_two_runs_at_once(meshes, tmp_path):
    import fcntl

    out = tmp_path / "out"
    out.mkdir()
    with open(out / ".lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        result = run(meshes, "--out", out)
    assert result.returncode == 2 and "another batch is writing here" in result.stderr
