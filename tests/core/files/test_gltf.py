"""Binary glTF by the package and by its command: what the file says, read as the specification has it."""

import io
import json
import struct
from contextlib import nullcontext

import families
import numpy as np
import pytest
from holomorph import Surface
from holomorph.__main__ import main
from holomorph.files import textures
from mesh_files import obj
from solved import solved, surface_of

PIL = pytest.importorskip("PIL.Image")
TRIANGLE, UV = np.eye(3), np.array([[0, 0], [1, 0], [0.25, 0.75]])
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}
KINDS = {5125: "<u4", 5126: "<f4"}
REPEAT = 10497


class Glb:
    """A file, taken apart."""

    def __init__(self, path):
        content = path.read_bytes()
        magic, version, length = struct.unpack_from("<4sII", content)
        assert (magic, version, length) == (b"glTF", 2, len(content)) and length % 4 == 0
        size, kind = struct.unpack_from("<I4s", content, 12)
        self.json = json.loads(content[20 : 20 + size])
        binary, second = struct.unpack_from("<I4s", content, 20 + size)
        self.binary = content[28 + size :]
        assert (kind, second, binary) == (b"JSON", b"BIN\0", len(self.binary))
        assert self.json["buffers"] == [{"byteLength": binary}] and size % 4 == 0
        (self.primitive,) = self.json["meshes"][0]["primitives"]

    def view(self, index):
        about = self.json["bufferViews"][index]
        assert about["byteOffset"] % 4 == 0
        content = self.binary[about["byteOffset"] :][: about["byteLength"]]
        assert len(content) == about["byteLength"]
        return content

    def rows(self, index):
        about = self.json["accessors"][index]
        values = np.frombuffer(self.view(about["bufferView"]), KINDS[about["componentType"]])
        rows = values.reshape(about["count"], SIZES[about["type"]])
        if "min" in about:
            assert (rows.min(axis=0) == about["min"]).all() and (rows.max(axis=0) == about["max"]).all()
        return rows

    def attribute(self, name):
        return self.rows(self.primitive["attributes"][name])

    @property
    def corners(self):
        return self.rows(self.primitive["indices"]).reshape(-1, 3)

    @property
    def image(self):
        """(media type, bytes) of the picture that the material shows, which repeats."""
        shown = self.json["materials"][self.primitive["material"]]["pbrMetallicRoughness"]["baseColorTexture"]
        texture = self.json["textures"][shown["index"]]
        sampler = self.json["samplers"][texture["sampler"]]
        assert sampler["wrapS"] == sampler["wrapT"] == REPEAT
        image = self.json["images"][texture["source"]]
        return image["mimeType"], self.view(image["bufferView"])


def picture_file(path, kind="PNG"):
    PIL.fromarray(np.arange(48, dtype=np.uint8).reshape(4, 4, 3)).save(path, kind)
    return path


def triangle(path, **options):
    Surface(TRIANGLE, [[0, 1, 2]]).write(path, UV, **options)
    return Glb(path)


def test_a_mesh_and_its_map_are_in_the_file(tmp_path):
    """Each corner where the surface has it: v counts from the top of images."""
    structure = solved("torus of quads")
    surface, uv = structure.surface, structure.uv(structure.balanced_coefficients())
    surface.write(tmp_path / "torus.glb", uv)
    found = Glb(tmp_path / "torus.glb")
    points = found.attribute("POSITION")[found.corners]
    assert (points == surface.vertices[surface.triangles].astype(np.float32)).all()
    values = found.attribute("TEXCOORD_0")[found.corners]
    assert (values == (uv * [1, -1] + [0, 1])[surface.triangle_corners].astype(np.float32)).all()


def test_the_same_bytes_on_every_run_and_no_map_where_there_is_none(tmp_path):
    surface = surface_of(families.cube())
    for name in ("one.glb", "other.glb"):
        surface.write(tmp_path / name)
    assert (tmp_path / "one.glb").read_bytes() == (tmp_path / "other.glb").read_bytes()
    found = Glb(tmp_path / "one.glb")
    assert list(found.primitive["attributes"]) == ["POSITION"] and "images" not in found.json


@pytest.mark.parametrize("kind", ["PNG", "JPEG"])
def test_an_image_is_in_the_file_byte_by_byte(kind, tmp_path):
    """Whatever it is called."""
    picture = picture_file(tmp_path / "picture.dat", kind)
    found = triangle(tmp_path / "out.glb", texture=picture)
    assert found.image == (f"image/{kind.lower()}", picture.read_bytes())


def test_a_checker_is_drawn_for_the_map(tmp_path):
    """An image that tiles, with a light square at the origin, and the more squares the smaller the map is."""
    ring, counts = surface_of(families.torus(24, 12)), []
    structure = solved("torus of quads")
    for factor in (0.5, 1.0, 100.0):
        uv = factor * structure.uv(structure.balanced_coefficients())
        structure.surface.write(tmp_path / "ring.glb", uv, texture="checker")
        media_type, content = Glb(tmp_path / "ring.glb").image
        image = np.array(PIL.open(io.BytesIO(content)).convert("RGB"))
        assert media_type == "image/png" and image.shape[0] == image.shape[1]
        assert tuple(image[-1, 0]) == textures.COLOURS[0] and tuple(image[0, 0]) == textures.COLOURS[1]
        count = 1 + np.count_nonzero((image[-1, 1:] != image[-1, :-1]).any(axis=1))
        assert len(image) % count == 0 and count % 2 == 0
        counts.append(count)
    assert counts[0] == pytest.approx(2 * counts[1], abs=2) and counts[2] == 2
    ring.write(tmp_path / "lost.glb", np.zeros((len(ring.corner_vertices), 2)), texture="checker")
    assert Glb(tmp_path / "lost.glb").image[0] == "image/png"


def test_pngs_are_what_was_drawn():
    image = np.random.default_rng(5).integers(0, 3, (7, 5)).astype(np.uint8)
    palette = np.array([[1, 2, 3], [40, 50, 60], [255, 0, 128]], np.uint8)
    found = PIL.open(io.BytesIO(textures.indexed_png(image, palette, b"\xff\x00")))
    assert (np.array(found.convert("RGBA"))[..., :3] == palette[image]).all()
    assert (np.array(found.convert("RGBA"))[..., 3] == np.array([255, 0, 255])[image]).all()


@pytest.mark.parametrize("name, uv, texture, told", [
    ("out.obj", UV, "checker", r"a texture goes into \.glb files alone, not into \.obj"),
    ("out.glb", None, "checker", "a texture needs uv"),
    ("out.glb", UV, "none.gif", "not a PNG or JPEG"),
])  # fmt: skip
def test_textures_that_do_not_fit_are_refused(name, uv, texture, told, tmp_path):
    (tmp_path / "none.gif").write_bytes(b"GIF89a")
    given = tmp_path / texture if "." in texture else texture
    with pytest.raises(ValueError, match=told):
        Surface(TRIANGLE, [[0, 1, 2]]).write(tmp_path / name, uv, given)
    assert not (tmp_path / name).exists()


def test_an_image_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(OSError, match=r"absent\.png"):
        triangle(tmp_path / "out.glb", texture=tmp_path / "absent.png")
    assert not (tmp_path / "out.glb").exists()


# ---- the command ---------------------------------------------------------------------------------------------------


@pytest.fixture
def cube(tmp_path):
    path = tmp_path / "cube.obj"
    path.write_bytes(obj(families.cube()))
    return path


def test_command_puts_the_texture_on_the_map(cube, tmp_path):
    picture, out = picture_file(tmp_path / "picture.png"), tmp_path / "out.glb"
    assert main([str(cube), "--output", str(out), "--texture", str(picture)]) == 0
    found = Glb(out)
    assert found.image == ("image/png", picture.read_bytes()) and np.ptp(found.attribute("TEXCOORD_0")) > 0.1


@pytest.mark.parametrize("options, told", [
    (["--output", "out.ply", "--texture", "checker"], "not into .ply"),
    (["--output", "out.glb", "--texture", "absent.png"], "absent.png"),
    (["--texture", "checker"], "--texture needs --output"),
])  # fmt: skip
def test_command_refuses_textures_before_it_reads(options, told, cube, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Surface, "read", None)
    assert main([str(cube), *options]) == 2
    said = capsys.readouterr().err
    assert told in said and len(said.splitlines()) == 1 and not {*tmp_path.iterdir()} - {cube}


def ball(folder, mesh):
    (folder / "ball.obj").write_bytes(obj(mesh))
    return folder / "ball.obj"


def drawn(path, turns):
    """A file with a picture that looks the same after these turns, about a place of its own."""
    y, x = np.indices((64, 64))
    spots = {4: (0, 1, 2, 3), 2: (0, 2)}[turns]
    grey = sum(np.cos(np.pi * (x * a + y * b) / 16) for a, b in [((1, 0), (0, 1), (-1, 0), (0, -1))[k] for k in spots])
    grey = np.roll(grey, (5, 9), (0, 1))
    PIL.fromarray(np.uint8(127 + 100 * grey / np.abs(grey).max())).save(path)
    return path


def colours_on_both_sides(found):
    """(n, 2) of the middles of the sides that two triangles have, beside each."""
    image = np.array(PIL.open(io.BytesIO(found.image[1])).convert("L"), float)
    points, uv = (found.attribute(name)[found.corners] for name in ("POSITION", "TEXCOORD_0"))
    sides = {}
    for corner in range(3):
        other = (corner + 1) % 3
        for ends, at in zip(points[:, [corner, other]], uv[:, [corner, other]].mean(axis=1)):
            key = tuple(np.round(ends.sum(axis=0), 5)), tuple(np.round(np.abs(ends[0] - ends[1]), 5))
            pixel = np.floor(at[::-1] * image.shape).astype(int) % image.shape
            sides.setdefault(key, []).append(image[tuple(pixel)])
    return np.array([pair for pair in sides.values() if len(pair) == 2])


@pytest.mark.parametrize(("texture", "turns"), [("checker", 4), (4, 4), (2, 2)])
def test_the_texture_of_a_map_that_turns_shows_no_seam(texture, turns, tmp_path):
    """The map takes the turns of the texture, and has their centre at the corners of tiles."""
    texture = texture if texture == "checker" else drawn(tmp_path / "picture.png", texture)
    mesh, report = ball(tmp_path, families.geodesic_sphere(12)), tmp_path / "report.json"
    options = ["--main", "seamless", "--turns", "auto", "--texture", str(texture), "--report", str(report)]
    assert main([str(mesh), "--output", str(tmp_path / "ball.glb"), *options]) == 0
    told = json.loads(report.read_text())
    assert told["components"][0]["tiling"]["turns"] == told["texture"]["turns"] == turns
    assert "Looks the same after" in told["texture"]["text"]
    colours = colours_on_both_sides(Glb(tmp_path / "ball.glb"))
    off = np.abs(colours[:, 0] - colours[:, 1])
    assert len(colours) > 1000 and np.quantile(off, 0.99) < 25 < np.ptp(colours)


def test_without_a_texture_auto_is_no_turn(tmp_path):
    mesh, report = ball(tmp_path, families.geodesic_sphere(4)), tmp_path / "report.json"
    assert main([str(mesh), "--main", "seamless", "--turns", "auto", "--report", str(report)]) == 0
    told = json.loads(report.read_text())
    assert told["components"][0]["tiling"]["turns"] == 1 and told["texture"] is None


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--turns", "3"], "--turns: invalid choice: 3"),
        (["--turns", "6", "--lines", "free"], "lines is 'free', for which turns must be 2 or 4"),
    ],
)
def test_wrong_turns_and_lines_are_named(options, told, tmp_path, capsys):
    with pytest.raises(SystemExit) if "3" in options else nullcontext():
        assert main([str(ball(tmp_path, families.geodesic_sphere(2))), *options]) == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize("far", [[5e5, 4.6e6, 100], [0, 0, -1e7], [3e8, 3e8, 3e8]])
def test_far_from_the_origin_a_node_has_the_place(far, tmp_path):
    """Single precision is half a metre there, and ten times that at 300,000 km."""
    body, path = families.torus(12, 8, shape="triangles"), tmp_path / "far.glb"
    Surface(body.vertices + far, body.faces).write(path)
    made = Glb(path)
    (node,) = made.json["nodes"]
    assert np.array_equal(np.float32(node["translation"]), node["translation"])
    assert np.abs(made.attribute("POSITION")).max() <= 2.5 * np.ptp(body.vertices, axis=0).max() + 32
    again = Surface.read(path)
    assert (again.genus, again.boundary_count) == (1, 0)
    places = again.vertices[again.corner_vertices] - far
    assert np.abs(places - body.vertices[body.corners]).max() < 4e-6


@pytest.mark.parametrize("far", [[0, 0, 0], [7, -3, 2]])
def test_near_the_origin_there_is_no_translation(far, tmp_path):
    body, path = families.torus(12, 8, shape="triangles"), tmp_path / "near.glb"
    Surface(body.vertices + far, body.faces).write(path)
    assert Glb(path).json["nodes"] == [{"mesh": 0}]
