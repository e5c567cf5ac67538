"""python -m holomorph relief: a mesh file and a picture to a file for a printer."""

import sys

import families
import numpy as np
import pytest
from heights import dots
from holomorph import Surface, height_image
from holomorph.__main__ import main
from holomorph.relief import volume
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


def run(*arguments, mesh="torus.obj", image="dots.png", output="part.stl", depth="1mm"):
    few = ("--most-triangles", "20000")
    return main(["relief", mesh, image, "--output", output, f"--depth={depth}", "--tiles", "40", *few, *arguments])


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
    from holomorph import relief_command

    torus = surface_of(families.torus(20, 12, shape="triangles"))
    both = np.concatenate([10 * torus.vertices, 10 * torus.vertices + (0, 0, 50)])
    faces = torus.triangles
    Surface(both, np.concatenate([faces, faces + len(torus.vertices)])).write("two.obj")
    made = relief_command.automatic_maps
    refusal = relief_command.Error("too small")
    monkeypatch.setattr(relief_command, "automatic_maps", lambda *a, **k: [made(*a, **k)[0], refusal])
    assert run(mesh="two.obj") == 0
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
    "no mesh": (dict(mesh="none.obj"), 1, "none.obj"),
    "no image": (dict(image="none.png"), 1, "none.png"),
    "mesh for an image": (dict(image="torus.obj"), 1, "not a readable picture"),
    "one pixel": (dict(image="pixel.png"), 1, "the height 0.0275 everywhere"),
    "half an image": (dict(image="half.png"), 1, "not a readable picture"),
    "no such folder": (dict(output="none/part.stl"), 1, "No such file or directory"),
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
    assert run(option, value) == 1
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
