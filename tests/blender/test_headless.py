"""The headless command as its users run it: in a Blender program of its own."""

import json
import os
import signal
import subprocess
import time

import bpy
import numpy as np
import pytest
from headless_runs import BLENDER, SCRIPT, SECONDS, headless, needs_program, our_lines, refusal, write_obj
from loaded_addon import module
from repository import ROOT
from scenes import limb_arrays, mesh_io, mesh_object, sphere_arrays, torus, torus_arrays, uv_maps


@pytest.fixture
def torus_file(tmp_path):
    return write_obj(tmp_path / "ring.obj", *torus_arrays())


def test_mesh_file_in_blend_picture_and_report_out(torus_file, tmp_path):
    blend, picture, report = tmp_path / "out.blend", tmp_path / "out.png", tmp_path / "report.json"
    done = headless(
        torus_file, "--output", blend, "--render", picture, "--report", report, "--resolution", 64, "--samples", 4
    )
    assert done.returncode == 0, done.stderr
    content = json.loads(report.read_text())
    assert content["objects"][0]["components"][0]["genus"] == 1
    assert content["objects"][0]["object"] == "ring"
    assert picture.read_bytes()[:4] == b"\x89PNG"
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    assert [o.name for o in bpy.data.objects] == ["ring"]
    mesh = bpy.data.objects["ring"].data
    vertices, faces = torus_arrays()
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    assert np.array_equal(corners, faces.ravel())
    positions = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", positions)
    assert np.array_equal(positions, vertices.astype(np.float32).ravel())
    assert [layer.name for layer in mesh.uv_layers] == ["Holomorphic", "Holomorphic 1"]
    assert np.ptp(uv_maps.read_map(mesh, "Holomorphic")) > 0.1


def test_blend_file_in(tmp_path):
    report, blend = tmp_path / "report.json", tmp_path / "out.blend"
    done = headless(
        "--report", report, "--output", blend, "--no-checker", blend=ROOT / "blend_examples" / "mixed.blend"
    )
    assert done.returncode == 0, done.stderr
    objects = {o["object"]: o for o in json.loads(report.read_text())["objects"]}
    assert [c["done"] for c in objects["Ring and Pearl"]["components"]] == [True, True]
    assert [c["done"] for c in objects["Bowl"]["components"]] == [True]
    assert all("even" in line.lower() for line in our_lines(done)), our_lines(done)  # verdicts, and nothing else


def test_options_reach_the_maps(torus_file, tmp_path):
    blend = tmp_path / "out.blend"
    done = headless(torus_file, "--output", blend, "--density", 2, "--forms", 0, "--seams", "--checker-scale", 8)
    assert done.returncode == 0, done.stderr
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    obj = bpy.data.objects["ring"]
    assert [layer.name for layer in obj.data.uv_layers] == ["Holomorphic"]
    assert mesh_io.read_seams(obj.data).any()
    assert obj.material_slots[0].material.node_tree.nodes["Checker Scale"].outputs[0].default_value == 8


def file_without_area(folder):
    vertices, faces = torus_arrays()
    return write_obj(folder / "flat.obj", vertices * (1, 0, 0), faces)


def broken_file(folder):
    path = folder / "broken.ply"
    path.write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n")
    return path


def directory(folder):
    return folder


def unknown_format(folder):
    path = folder / "mesh.xyz"
    path.write_text("0 0 0\n")
    return path


@pytest.mark.parametrize(
    ("make", "status"), [(file_without_area, 1), (broken_file, 1), (directory, 2), (unknown_format, 2)]
)
def test_a_file_that_cannot_be_done(make, status, tmp_path):
    blend = tmp_path / "out.blend"
    assert refusal(make(tmp_path), "--output", blend, status=status)
    assert not blend.exists()


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ([], "mesh file"),
        (["missing.obj"], "no such file"),
        (["--bogus"], "bogus"),
        (["ring.obj", "--solver", "guess"], "'guess' is not one of auto"),
        (["ring.obj", "--density", "-1"], "density"),
        (["ring.obj", "--forms", "many"], "forms"),
        (["ring.obj", "--evenness", "1.5"], "1.5 is not from 0 to 1"),
        (["ring.obj", "--margin", "-1"], "-1 is not from 0"),
        (["ring.obj", "--levels", "2", "--ratio", "1.5"], "ratio"),
        (["ring.obj", "--export-texture", "--no-checker"], "cannot be combined"),
        (["ring.obj", "--output", "nowhere/out.blend"], "folder"),
        (["ring.obj", "--output", "foo.txt"], "must end with .blend"),
        (["ring.obj", "--render", "picture.jpg"], "must end with .png"),
        (["ring.obj", "--output", "ring.obj"], "--overwrite to replace it"),
        (["ring.obj", "--report", "report"], "must end with .json"),
    ],
)
def test_usage_errors_are_one_sentence(arguments, word, torus_file, tmp_path):
    arguments = [str(tmp_path / a) if a.endswith((".obj", ".blend")) else a for a in arguments]
    assert word in refusal(*arguments)


def test_the_context_belongs_to_no_scene_after_the_command(torus_file, tmp_path):
    """See tests/core/repository/test_architecture.py."""
    module("command_line.command").main([str(torus_file), "--seamless", "--report", str(tmp_path / "report.json")])
    assert bpy.context.id_data is None


def test_a_usage_error_of_a_program_of_its_own():
    done = headless("--bogus")
    assert done.returncode == 2
    assert len(our_lines(done)) == 1 and "bogus" in our_lines(done)[0]
    assert "Traceback" not in done.stderr + done.stdout


def test_levels_of_detail_in_the_file_and_in_the_report(torus_file, tmp_path):
    blend, report = tmp_path / "out.blend", tmp_path / "report.json"
    done = headless(torus_file, "--levels", 2, "--ratio", 0.5, "--side-by-side", "--output", blend, "--report", report)
    assert done.returncode == 0, done.stderr
    (entry,) = json.loads(report.read_text())["objects"]
    assert entry["levels"] == [{"object": "ring_LOD1", "triangles": 288}, {"object": "ring_LOD2", "triangles": 144}]
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    assert sorted(bpy.data.collections["ring LODs"].objects.keys()) == ["ring_LOD1", "ring_LOD2"]
    assert bpy.data.objects["ring_LOD2"].data.uv_layers.active.name == "Holomorphic"


def test_object_option(tmp_path):
    blend = ROOT / "blend_examples" / "mixed.blend"
    done = headless("--object", "Bowl", blend=blend)
    assert done.returncode == 0 and "written to Bowl in" in done.stdout
    assert "Nobody" in refusal("--object", "Nobody", blend=blend)


def test_the_picture_is_written_under_the_given_name_or_its_absence_is_said(torus_file, tmp_path):
    small = ("--resolution", 32, "--samples", 1)
    picture = tmp_path / "picture.of a ring.png"
    assert headless(torus_file, "--render", picture, *small).returncode == 0
    assert picture.read_bytes()[:4] == b"\x89PNG"
    (tmp_path / "folder.png").mkdir()
    done = headless(torus_file, "--render", tmp_path / "folder.png", *small)
    assert done.returncode == 2 and "Traceback" not in done.stderr + done.stdout


def test_a_file_saved_in_edit_mode_and_without_an_active_object(tmp_path):
    torus()
    bpy.ops.object.mode_set(mode="EDIT")
    path = tmp_path / "editing.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    assert headless(blend=path).returncode == 0
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = None
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    assert headless(blend=path).returncode == 0


def test_a_blend_file_without_a_mesh(tmp_path):
    path = tmp_path / "nothing.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    assert "no mesh object" in refusal(blend=path, status=1)


def grid_file(folder, count=12):
    """A bent square sheet; vertex i (count + 1) + j is column i, row j."""
    i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
    vertices = np.stack([i, j, 0.05 * i * j], -1).reshape(-1, 3)
    a = (i * (count + 1) + j)[:-1, :-1].ravel()
    return write_obj(folder / "sheet.obj", vertices, np.stack([a, a + count + 1, a + count + 2, a + 1], -1))


def sphere_file(folder):
    return write_obj(folder / "sphere.obj", *sphere_arrays())


def reported(path):
    (entry,) = json.loads(path.read_text())["objects"][0]["components"]
    return entry


def test_poles_and_residues(torus_file, tmp_path):
    report = tmp_path / "report.json"
    chosen = ("--pole", 3, "--pole", 150, "--residues", "2+1j -2-1j")
    assert headless(torus_file, "--report", report, *chosen).returncode == 0
    assert reported(report)["poles"] == [3, 150]
    assert reported(report)["residues"] == [[2, 1], [-2, -1]]


def test_choices_that_do_not_fit_are_one_sentence(torus_file, tmp_path):
    """With 2 whatever the mesh, with 1 where the mesh is another."""
    for path, options, status, word in (
        (torus_file, ("--pole", 3), 1, "pole 3"),
        (torus_file, ("--pole", 3, "--pole", 100000), 1, "100000"),
        (torus_file, ("--pole", 3, "--pole", 150, "--residues", "1 1"), 1, "residues"),
        (torus_file, ("--pole", 3, "--rectangle", 0, 1, 2, 3), 2, "cannot be combined"),
        (torus_file, ("--pole", 3, "--pole", 150, "--residues", "a b"), 2, "'a' is not a number"),
        (grid_file(tmp_path), ("--rectangle", 0, 168, 156, 84), 1, "84"),
    ):
        assert word in refusal(path, *options, status=status)


def test_choices_need_one_object(tmp_path):
    assert "--object" in refusal("--pole", 3, blend=ROOT / "blend_examples" / "mixed.blend")


def test_the_shape_of_a_sphere(tmp_path):
    blend = tmp_path / "out.blend"
    assert headless(sphere_file(tmp_path), "--shape", "--output", blend).returncode == 0
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    mesh = bpy.data.objects["sphere"].data
    points = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["Holomorphic Shape"].data.foreach_get("vector", points)
    assert np.abs(np.linalg.norm(points.reshape(-1, 3), axis=1) - 1).max() < 1e-5


def test_rectangle_and_disk(tmp_path):
    report, path = tmp_path / "report.json", grid_file(tmp_path)
    assert headless(path, "--report", report, "--rectangle", 0, 168, 156, 12).returncode == 0
    assert reported(report)["description"].startswith("rectangle")
    assert headless(path, "--report", report, "--pole", 84).returncode == 0
    assert reported(report)["description"].startswith("disk")


def test_selection_and_seams_of_a_blend_file(tmp_path):
    report = tmp_path / "report.json"
    blend = ROOT / "blend_examples" / "mask.blend"
    assert headless("--report", report, "--selection", "automatic", blend=blend).returncode == 0
    objects = {o["object"]: o["components"][0] for o in json.loads(report.read_text())["objects"]}
    assert objects["Mask as Disk"]["description"].startswith("disk")
    assert objects["Mask as Rectangle"]["description"].startswith("rectangle")


def test_the_main_map_and_the_tiling_of_the_command_line(tmp_path):
    path, report = write_obj(tmp_path / "limb.obj", *limb_arrays()), tmp_path / "report.json"
    assert headless(path, "--report", report).returncode == 0
    assert "seamless" in reported(report)["main_map"]["verdict"]["sentence"]
    assert headless(path, "--report", report, "--main", "balanced").returncode == 0
    assert "tiling" not in reported(report)
    options = ("--seamless", "--tiles", 200, "--poles", 6, "--lattice", "hex", "--direction", "z", "--rotation", 30)
    done = headless(path, "--report", report, *options, "--boundary", "free")
    assert done.returncode == 0, done.stderr
    assert len(reported(report)["tiling"]["poles"]) == 6


def test_an_image_of_the_users_on_the_command_line(tmp_path, torus_file):
    """In a glTF file, too, where it is laid on as high as it is."""
    rows = np.indices((32, 64)).sum(axis=0) // 8 % 2
    image = bpy.data.images.new("Rows", 64, 32)
    image.pixels.foreach_set(np.dstack([rows, rows, rows, 1 + 0 * rows]).astype(np.float32).ravel())
    image.filepath_raw, image.file_format = str(tmp_path / "rows.png"), "PNG"
    image.save()
    report, made = tmp_path / "report.json", tmp_path / "made.glb"
    options = ("--seamless", "--texture", "image", "--source", tmp_path / "rows.png", "--size", 0.5, "--poles", 0)
    done = headless(torus_file, "--report", report, "--output", made, "--export-texture", *options)
    assert done.returncode == 0, done.stderr
    own = json.loads(report.read_text())["objects"][0]["dials"]["own"]
    assert own["text"].startswith("Tiles; ") and own["height"] == 0.5
    assert b'"scale":[1,2]' in made.read_bytes().replace(b" ", b"").replace(b".0", b"")


@pytest.mark.parametrize(
    ("options", "word"),
    [
        (("--texture", "image"), "Choose an image"),
        (("--texture", "image", "--source", "absent.png"), "no image 'absent.png'"),
        (("--texture", "material", "--source", "Absent"), "no material 'Absent'"),
        (("--size", -1), "-1 is not from 0"),
    ],
)
def test_textures_that_are_not_there(options, word, torus_file):
    assert word in refusal(torus_file, *options)


@pytest.mark.parametrize(("options", "turns"), [((), 4), (("--texture", "bricks"), 2), (("--turns", "none"), 1)])
def test_turns_of_the_command_line(options, turns, torus_file, tmp_path):
    report = tmp_path / "report.json"
    done = headless(torus_file, "--report", report, "--seamless", *options)
    assert done.returncode == 0, done.stderr
    (entry,) = json.loads(report.read_text())["objects"]
    assert entry["asked"]["turns"] == turns == entry["components"][0]["tiling"]["turns"]


def test_tiles_are_over_all_objects_of_a_file(tmp_path):
    for scale in (1.0, 2.0):
        mesh_object(f"Limb {scale}", *limb_arrays()).scale = (scale, scale, scale)
    blend, report = tmp_path / "limbs.blend", tmp_path / "report.json"
    bpy.ops.wm.save_as_mainfile(filepath=str(blend), copy=True)
    done = headless("--report", report, "--seamless", "--tiles", 300, blend=blend)
    assert done.returncode == 0, done.stderr
    tilings = [entry["components"][0]["tiling"] for entry in json.loads(report.read_text())["objects"]]
    assert len(tilings) == 2 and sum(tiling["tiles"] for tiling in tilings) == pytest.approx(300, rel=0.1)


@pytest.mark.parametrize(
    ("options", "word"),
    [
        (("--seamless", "--poles", "many"), "'many' is not automatic"),
        (("--seamless", "--tiles", -3), "-3 is not from 0"),
        (("--seamless", "--pole-group", "Hidden"), "no vertex group 'Hidden'"),
        (("--seamless", "--boundary", "double_cover"), "--boundary"),
        (("--boundary", "free"), "--boundary"),
        (("--seamless", "--turns", "half", "--poles", "4"), "a map with half turns has no choice of Points"),
    ],
)
def test_options_of_a_tiling_that_cannot_be(options, word, torus_file):
    assert word in refusal(torus_file, *options)


@pytest.mark.parametrize(("strict", "status"), [((), 0), (("--strict",), 3)])
def test_strict_ends_with_the_verdict_and_everything_written(tmp_path, strict, status):
    path, report = sphere_with_spikes(tmp_path / "spikes.obj"), tmp_path / "report.json"
    done = headless(path, "--main", "balanced", "--report", report, *strict)
    (entry,) = json.loads(report.read_text())["objects"]
    assert done.returncode == status and entry["verdict"]["level"] in ("poor", "unusable")
    assert any(entry["verdict"]["sentence"].lower() in line.lower() for line in our_lines(done))
    assert not strict or len(our_lines(done)) == 1


def sphere_with_spikes(path):
    vertices, faces = sphere_arrays(4)
    vertices = np.array(vertices)
    factor = 1 + 6 * np.exp(-24 * (0.5 - vertices.max(axis=1)))
    return write_obj(path, vertices * factor[:, None], faces)


def test_islands_of_a_blend_file(tmp_path):
    obj, report = torus(around=24, across=12), tmp_path / "report.json"
    row, column = np.divmod(np.array([e.vertices for e in obj.data.edges]), 12)
    obj.data.edges.foreach_set("use_seam", (row == 0).all(axis=1) | (column == 0).all(axis=1))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "ring.blend"))
    done = headless("--main", "islands", "--no-checker", "--report", report, blend=tmp_path / "ring.blend")
    assert done.returncode == 0, done.stderr
    (entry,) = json.loads(report.read_text())["objects"][0]["components"]
    assert (entry["genus"], entry["boundary_count"]) == (0, 1)
    assert entry["description"].startswith("free boundary")


@needs_program
def test_a_script_in_the_file_does_not_run(tmp_path):
    """With --disable-autoexec, as the documentation has it; with --enable-autoexec it does."""
    torus("Ring")
    script, mark = bpy.data.texts.new("script.py"), tmp_path / "ran"
    script.write(f"open({str(mark)!r}, 'w')")
    script.use_module = True
    blend = tmp_path / "file.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(blend), check_existing=False)
    assert headless("--report", tmp_path / "report.json", blend=blend).returncode == 0
    assert not mark.exists()
    subprocess.run([BLENDER, "-b", "--factory-startup", "--enable-autoexec", str(blend)], check=True)
    assert mark.exists()


def test_a_link_is_of_the_kind_that_its_own_name_says(torus_file, tmp_path):
    """The file that is read, and the one that is replaced, where the link stays."""
    read, replaced = tmp_path / "blob", tmp_path / "other blob"
    torus_file.rename(read)
    torus_file.symlink_to(read)
    replaced.write_bytes(b"old")
    output = tmp_path / "out.blend"
    output.symlink_to(replaced)
    done = headless(torus_file, "--output", output, "--report", tmp_path / "report.json")
    assert done.returncode == 0, done.stderr
    assert output.is_symlink() and replaced.read_bytes() != b"old"
    with bpy.data.libraries.load(str(output)) as (there, _):
        assert there.objects == ["ring"]
    assert not list(tmp_path.glob(".*")) and not list(tmp_path.glob("*.blend1"))


@needs_program
def test_interrupted(torus_file, tmp_path):
    """While it waits for who reads its report: Ctrl-C ends it, not a second one."""
    output, report = tmp_path / "out.blend", tmp_path / "report.json"
    os.mkfifo(report)
    command = [BLENDER, "-b", "--factory-startup", "--python-exit-code", "1", "--python", SCRIPT, "--", torus_file]
    command += ["--output", output, "--report", report]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        while not output.exists():
            assert process.poll() is None
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=SECONDS)
    assert process.returncode == 130, said
    assert "Holomorph: interrupted; files already written are complete" in said.splitlines()
    with bpy.data.libraries.load(str(output)) as (there, _):
        assert there.objects == ["ring"]
