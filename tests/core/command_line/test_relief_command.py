"""python -m holomorph relief: a mesh file and a picture to a file for a printer."""

import sys

import families
import numpy as np
import pytest
import solids
from heights import dots
from holomorph import Surface, height_image
from holomorph.__main__ import main
from holomorph.tiles.relief import volume
from holomorph.tiles.shells import FEW, outward, with_room
from solved import surface_of

PIL = pytest.importorskip("PIL.Image")


def save(path, values):
    PIL.fromarray(values).save(path)
    return path


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """With torus.obj, inside out as inwards.obj, open as bowl.obj, and dots.png."""
    monkeypatch.chdir(tmp_path)
    torus = surface_of(families.torus(40, 24, shape="triangles"))
    Surface(10 * torus.vertices, torus.triangles).write("torus.obj")
    Surface(10 * torus.vertices, torus.triangles[:, ::-1]).write("inwards.obj")
    surface_of(families.hemisphere(12)).write("bowl.obj")
    save("dots.png", (255 * dots(32)).astype(np.uint8))
    return tmp_path


def run(*arguments, mesh="torus.obj", image="dots.png", output="part.stl", depth="1mm", tiles="40"):
    more = ["--most-triangles", "20000"] + (["--tiles", tiles] if tiles else [])
    return main(["relief", mesh, image, "--output", output, f"--depth={depth}", *more, *arguments])


def written(name="part.stl"):
    return Surface.read(name, strict=True)


def of(surface):
    return volume(surface.vertices, surface.triangles)


def test_a_closed_mesh_gets_a_closed_relief(folder, capsys):
    assert run() == 0
    before, after = Surface.read("torus.obj"), written()
    assert (after.genus, after.boundary_count) == (1, 0)
    assert 0.1 * before.area < of(after) - of(before) < 0.6 * before.area  # a disk has 0.28 of a tile
    told = capsys.readouterr().out
    assert "triangles, 1 mm deep" in told
    assert "crosses" not in told


SOLIDS = {
    "tetrahedron": lambda: surface_of(families.tetrahedron()),
    "cube": lambda: surface_of(families.cube()),
    "prism": lambda: solids.can(5),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_a_coarse_solid_gets_smaller_triangles_first(name, folder):
    """Its few faces meet at any two poles, where all that is raised fades out."""
    coarse = SOLIDS[name]()
    solid = Surface.from_polygons(20 * coarse.vertices, coarse.corner_vertices, coarse.face_offsets)
    fine = with_room(solid)
    assert len(fine.triangles) >= FEW and (fine.genus, fine.boundary_count) == (0, 0)
    assert fine.area == pytest.approx(solid.area) and of(fine) == pytest.approx(of(solid)) and with_room(fine) is fine
    solid.write("solid.obj")
    assert run(mesh="solid.obj") == 0
    assert (written().genus, written().boundary_count) == (0, 0)
    assert 0.02 * solid.area < of(written()) - of(solid) < 0.4 * solid.area


def test_units(folder):
    assert run() == 0
    one = written()
    assert run(depth="0.1cm") == 0
    assert np.array_equal(written().vertices, one.vertices)
    assert run("--unit", "cm", depth="10") == 0
    assert of(written()) == pytest.approx(1000 * of(one), rel=1e-2)


def test_a_mesh_inside_out_is_turned_over(folder):
    assert run(mesh="inwards.obj") == 0
    assert of(written()) > abs(of(Surface.read("inwards.obj")))


def test_it_engraves(folder):
    assert run("--level", "1") == 0
    assert 0 < of(written()) < of(Surface.read("torus.obj"))


def test_an_open_mesh_stays_open_and_is_told(folder, capsys):
    arguments = dict(mesh="bowl.obj", depth="0.02mm")
    assert run(**arguments) == 0
    assert "the mesh is open" in capsys.readouterr().out
    assert written().boundary_count == 1
    assert run("--strict", **arguments) == 3


def test_it_tells_that_it_crosses_itself(folder, capsys):
    assert run("--strict", depth="14mm") == 3
    told = capsys.readouterr().out
    assert "it crosses itself in" in told
    assert "mm deep it does not" in told


def test_it_tells_that_the_mesh_itself_crosses(folder, capsys):
    torus = Surface.read("torus.obj")
    both = np.concatenate([torus.vertices, torus.vertices + (15, 3, 1)])
    Surface(both, np.concatenate([torus.triangles, torus.triangles + len(torus.vertices)])).write("two.obj")
    assert run(mesh="two.obj") == 0
    assert "mm it still does" in capsys.readouterr().out


def test_it_tells_how_far_triangles_are_off(folder, capsys):
    assert run("--most-triangles", "2000") == 0
    assert "the limit on the triangles was reached" in capsys.readouterr().out


def test_parts_without_a_tiling_stay_plain(folder, capsys, monkeypatch):
    from holomorph.commands import relief_command

    torus = surface_of(families.torus(20, 12, shape="triangles"))
    both = np.concatenate([10 * torus.vertices, 10 * torus.vertices + (0, 0, 50)])
    faces = torus.triangles
    Surface(both, np.concatenate([faces, faces + len(torus.vertices)])).write("two.obj")
    made = relief_command.automatic_maps
    refusal = relief_command.Error("too small")
    monkeypatch.setattr(relief_command, "automatic_maps", lambda *a, **k: [made(*a, **k)[0], refusal])
    assert run(mesh="two.obj", output="none.stl") == 1
    assert "1 of 2 parts would stay flat with --tiles 40: too small" in capsys.readouterr().err
    assert not (folder / "none.stl").exists()
    assert run(mesh="two.obj", tiles=None) == 0
    assert "1 of 2 parts stay flat: too small" in capsys.readouterr().out
    assert sorted(len(part.triangles) for part in written().components)[0] == len(faces)
    monkeypatch.setattr(relief_command, "automatic_maps", lambda *a, **k: [refusal, refusal])
    assert run(mesh="two.obj", output="none.stl") == 1
    assert "no seamless tiling: too small" in capsys.readouterr().err
    assert not (folder / "none.stl").exists()


BAD = {
    "no depth": (dict(depth="0mm"), 2, "must be positive"),
    "negative depth": (dict(depth="-1mm"), 2, "must be positive"),
    "depth that is not a number": (dict(depth="nan"), 2, "must be positive"),
    "endless depth": (dict(depth="inf"), 2, "must be positive"),
    "depth of two points": (dict(depth="1.2.3mm"), 2, "is not a number"),
    "no length": (dict(depth="deep"), 2, "a length such as 1.2mm"),
    "unknown unit": (dict(depth="1 furlong"), 2, "the units are mm, cm, m, in, um"),
    "depth above the mesh": (dict(depth="10m"), 1, "more than the size of the whole mesh"),
    "ending": (dict(output="part.txt"), 2, "must end with .stl, .3mf or .obj"),
    "own mesh": (dict(output="torus.obj"), 2, "--overwrite"),
    "no mesh": (dict(mesh="none.obj"), 2, "none.obj"),
    "no image": (dict(image="none.png"), 2, "none.png"),
    "mesh for an image": (dict(image="torus.obj"), 1, "not a readable picture"),
    "one pixel": (dict(image="pixel.png"), 1, "the height 0.0275 everywhere"),
    "half an image": (dict(image="half.png"), 1, "not a readable picture"),
    "no such folder": (dict(output="none/part.stl"), 2, "does not exist"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_one_sentence_and_nothing_is_written(name, folder, capsys):
    save("pixel.png", np.array([[7]], np.uint8))
    (folder / "half.png").write_bytes((folder / "dots.png").read_bytes()[:60])
    options, status, message = BAD[name]
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert run("--level", "0", **options) == status
    told = capsys.readouterr()
    assert message in told.err
    assert told.err.count("\n") == 1
    assert not told.out
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize(("option", "value"), [("--level", "2"), ("--tolerance", "nan"), ("--most-triangles", "-4")])
def test_other_options_that_cannot_be(option, value, folder, capsys):
    assert run(option, value) == 2
    assert f"{option[2:].replace('-', '_')} is {value}" in capsys.readouterr().err
    assert not (folder / "part.stl").exists()


def test_pictures(tmp_path):
    ramp = np.arange(256, dtype=np.uint8).reshape(4, 64)
    assert np.array_equal(height_image(save(tmp_path / "a.png", ramp)), ramp / 255)
    deep = (np.arange(256, dtype=np.uint16) * 257 + 1).reshape(4, 64)[:, ::-1]
    assert np.array_equal(height_image(save(tmp_path / "b.png", np.ascontiguousarray(deep))), deep / 65535)
    grey = np.repeat(ramp[:, :, None], 3, axis=2)
    assert np.array_equal(height_image(save(tmp_path / "c.png", grey)), ramp / 255)


def test_without_pillow_it_says_so(tmp_path, monkeypatch):
    picture = save(tmp_path / "a.png", np.zeros((2, 2), np.uint8))
    monkeypatch.setitem(sys.modules, "PIL", None)
    with pytest.raises(ValueError, match=r"pip install holomorph\[relief\]"):
        height_image(picture)


def shells(*turned):
    """Two tori side by side, and a small one in the wall of each, where it is a hollow; in turn, `turned` or right."""
    torus = surface_of(families.torus(40, 24, shape="triangles"))
    vertices, faces, triangles = [], [], torus.triangles
    for k, is_turned in enumerate(turned):
        scale = 10 if k % 2 == 0 else 1
        right = triangles if k % 2 == 0 else triangles[:, ::-1]
        place = np.array([60 * (k // 2) + (20 if k % 2 else 0), 0, 0])
        faces.append((right[:, ::-1] if is_turned else right) + len(torus.vertices) * k)
        vertices.append(scale * torus.vertices + place)
    return Surface(np.concatenate(vertices), np.concatenate(faces))


@pytest.mark.parametrize("turned", [(0, 0, 0, 0), (1, 0, 0, 0), (0, 1, 0, 0), (1, 1, 1, 1), (0, 0, 1, 1), (1, 0, 0, 1)])
def test_each_shell_is_turned_by_its_own_nesting(turned):
    made, count = outward(shells(*turned))
    assert count == sum(turned)
    volumes = [of(part) for part in made.components]
    assert [volume > 0 for volume in volumes] == [True, False, True, False]
    assert volumes == pytest.approx([of(part) for part in shells(0, 0, 0, 0).components])
    again, none = outward(made)
    assert again is made and none == 0


def test_shells_in_shells_alternate():
    """Five tori around one core line, each inside the one before."""
    torus = surface_of(families.torus(24, 16, R=3.0, r=1.0, shape="triangles"))
    middle = torus.vertices * [1, 1, 0]
    middle *= 3 / np.linalg.norm(middle, axis=1, keepdims=True)
    tubes = [middle + size * (torus.vertices - middle) for size in (0.2, 0.9, 0.6, 0.4, 0.8)]
    faces = [torus.triangles + len(torus.vertices) * k for k in range(5)]
    made, count = outward(Surface(np.concatenate(tubes), np.concatenate(faces)))
    assert [of(part) > 0 for part in made.components] == [True, True, True, False, False]
    assert count == 2


def test_open_parts_stay_as_they_are(folder):
    bowl = surface_of(families.hemisphere(12))
    torus = Surface.read("inwards.obj")
    both = Surface(
        np.concatenate([torus.vertices, bowl.vertices + (90, 0, 0)]),
        np.concatenate([torus.triangles, bowl.triangles + len(torus.vertices)]),
    )
    made, count = outward(both)
    assert count == 1
    assert np.array_equal(made.components[1].corner_vertices, both.components[1].corner_vertices)


def test_it_tells_of_turned_shells_and_stretched_pictures(folder, capsys):
    save("wide.png", (255 * np.tile(dots(32), (1, 2))).astype(np.uint8))
    assert run(mesh="inwards.obj", image="wide.png") == 0
    told = capsys.readouterr().out
    assert "1 shell was inside out: it was turned" in told
    assert "64 x 32 pixels: each tile shows it stretched to a square, by 2" in told
