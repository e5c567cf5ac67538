"""The headless program: as its users run it, in a Blender of its own, and in this one."""

import json
import os
import signal
import subprocess
import time

import bpy
import numpy as np
import pytest
from exchange_formats import SCENES, write
from headless_runs import BLENDER, SCRIPT, SECONDS, headless, needs_program, our_lines, pressed_here, refusal, write_obj
from loaded_addon import module
from repository import ROOT
from scenes import limb_arrays, mesh_object, torus, torus_arrays, uv_maps


@pytest.fixture
def torus_file(tmp_path):
    return write_obj(tmp_path / "ring.obj", *torus_arrays())


def saved(path):
    bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False)
    return path


def test_a_model_in_a_blend_file_and_a_report_out(torus_file, tmp_path):
    blend, report = tmp_path / "out.blend", tmp_path / "report.json"
    done = headless(torus_file, "--output", blend, "--report", report, "--set", "main=BALANCED", "--set", "forms=1")
    assert done.returncode == 0, done.stderr
    (entry,) = json.loads(report.read_text())["objects"]
    assert (entry["object"], entry["components"][0]["genus"]) == ("ring", 1)
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    assert [o.name for o in bpy.data.objects] == ["ring"]
    mesh = bpy.data.objects["ring"].data
    assert [layer.name for layer in mesh.uv_layers] == ["Holomorphic", "Holomorphic 1"]
    assert np.ptp(uv_maps.read_map(mesh, "Holomorphic")) > 0.1


@pytest.mark.parametrize("suffix", SCENES)
def test_models_of_other_programs(suffix, tmp_path):
    """With the materials of their objects, and other objects beside them."""
    ring = torus("Ring")
    ring.data.materials.append(bpy.data.materials.new("Red"))
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Eye", bpy.data.cameras.new("Eye")))
    write(tmp_path / f"scene{suffix}")
    pressed_here(tmp_path / f"scene{suffix}", "--set", "checker=False", "--output", tmp_path / "out.blend")
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "out.blend"))
    (ring,) = [obj for obj in bpy.data.objects if obj.type == "MESH"]
    assert ring.material_slots[0].material.name == "Red" and "Holomorphic" in ring.data.uv_layers


def test_a_blend_file_in(tmp_path):
    report, blend = tmp_path / "report.json", ROOT / "blend_examples" / "mixed.blend"
    for arguments, opened in (((), blend), ((blend,), "")):
        done = headless(*arguments, "--report", report, "--set", "checker=False", blend=opened)
        assert done.returncode == 0 and not our_lines(done), done.stderr
        objects = {o["object"]: o for o in json.loads(report.read_text())["objects"]}
        assert [c["done"] for c in objects["Ring and Pearl"]["components"]] == [True, True]
        assert [c["done"] for c in objects["Bowl"]["components"]] == [True]


def test_buttons_in_their_order(tmp_path):
    """Each with its own properties: a tiling, and levels of it."""
    torus("Ring")
    blend, out = saved(tmp_path / "in.blend"), tmp_path / "out.blend"
    pressed = ("--press", "tile", "--set", "tiles=24", "--press", "levels", "--set", "levels=2", "--set", "ratio=0.5")
    pressed_here(*pressed, "--output", out, blend=blend)
    bpy.ops.wm.open_mainfile(filepath=str(out))
    assert bpy.data.objects["Ring"].holomorph_map.tiles == 24
    assert {"Ring_LOD1", "Ring_LOD2"} <= set(bpy.data.collections["Ring LODs"].objects.keys())


def unknown_format(folder):
    path = folder / "mesh.xyz"
    path.write_text("0 0 0\n")
    return path


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ([], "no file"),
        (["missing.obj"], "No such file"),
        (["mesh.xyz"], "must end with .blend"),
        (["--seamless"], "--set NAME=VALUE"),  # an option of before
        (["ring.obj", "--press", "wires"], "invalid choice: 'wires'"),
        (["ring.obj", "--set", "solver=guess"], "'paper'"),
        (["ring.obj", "--set", "hue=1"], "hue"),
        (["ring.obj", "--set", "tiles"], "tiles"),
        (["ring.obj", "--set", "forms=many"], "forms=many"),
        (["ring.obj", "--set", "evenness=1.5"], "it is not from 0 to 1"),
        (["ring.obj", "--press", "bake", "--set", "folder=nowhere"], "no such folder"),
        (["ring.obj", "--output", "nowhere/out.blend"], "folder"),
        (["ring.obj", "--output", "foo.glb"], "must end with .blend"),
        (["ring.obj", "--output", "ring.obj"], "must end with .blend"),
        (["ring.obj", "--report", "report"], "must end with .json"),
    ],
)
def test_mistakes_are_one_sentence(arguments, word, torus_file, tmp_path):
    unknown_format(tmp_path)
    arguments = [str(tmp_path / a) if a.endswith((".obj", ".xyz")) else a for a in arguments]
    assert word in refusal(*arguments)


def test_the_context_belongs_to_no_scene_after_the_program(torus_file, tmp_path):
    """See tests/core/repository/test_architecture.py."""
    program = module("headless")
    program.process(program.parse([str(torus_file), "--report", str(tmp_path / "report.json")]))
    assert bpy.context.id_data is None


def test_a_mistake_in_a_program_of_its_own(tmp_path):
    done = headless("--bogus")
    assert done.returncode == 2
    assert len(our_lines(done)) == 1 and "bogus" in our_lines(done)[0]
    assert "Traceback" not in done.stderr + done.stdout


def test_a_file_that_is_refused_has_a_report(tmp_path):
    path, report, out = tmp_path / "broken.glb", tmp_path / "report.json", tmp_path / "out.blend"
    path.write_bytes(b"nothing of the kind")
    done = headless(path, "--report", report, "--output", out)
    assert done.returncode == 1 and len(our_lines(done)) == 1 and "Traceback" not in our_lines(done)[0]
    (entry,) = json.loads(report.read_text())["objects"]
    assert entry["object"] == "broken" and not entry["done"] and entry["refused"]
    assert not out.exists()


def test_what_is_not_done_is_told(tmp_path):
    """A mesh without area, of two objects, and alone."""
    vertices, faces = torus_arrays()
    mesh_object("Flat", vertices * (1, 0, 0), faces)
    report, blend = tmp_path / "report.json", saved(tmp_path / "flat.blend")
    assert "Flat: " in refusal("--report", report, blend=blend, status=1)
    torus("Ring")
    options = module("headless").parse(["--report", str(report), str(saved(blend))])
    module("headless").process(options)
    done = {entry["object"]: entry["done"] for entry in json.loads(report.read_text())["objects"]}
    assert done == {"Flat": False, "Ring": True}


def test_object_option(tmp_path):
    blend, report = ROOT / "blend_examples" / "mixed.blend", tmp_path / "report.json"
    pressed_here("--object", "Bowl", "--report", report, blend=blend)
    assert [entry["object"] for entry in json.loads(report.read_text())["objects"]] == ["Bowl"]
    assert "Nobody" in refusal("--object", "Nobody", blend=blend, status=1)


def test_a_file_saved_in_edit_mode_and_without_an_active_object(tmp_path):
    torus()
    bpy.ops.object.mode_set(mode="EDIT")
    assert headless(blend=saved(tmp_path / "editing.blend")).returncode == 0
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = None
    assert headless(blend=saved(tmp_path / "editing.blend")).returncode == 0


def test_a_blend_file_without_a_mesh(tmp_path):
    assert "no mesh object" in refusal(blend=saved(tmp_path / "nothing.blend"), status=1)


def test_an_image_of_the_users(tmp_path, torus_file):
    """That of a file, or of the .blend file."""
    rows = np.indices((32, 64)).sum(axis=0) // 8 % 2
    image = bpy.data.images.new("Rows", 64, 32)
    image.pixels.foreach_set(np.dstack([rows, rows, rows, 1 + 0 * rows]).astype(np.float32).ravel())
    image.filepath_raw, image.file_format = str(tmp_path / "rows.png"), "PNG"
    image.save()
    report, options = tmp_path / "report.json", ("--set", "texture=IMAGE", "--set", "size=0.5")
    pressed_here(torus_file, "--report", report, *options, "--set", f"source={tmp_path / 'rows.png'}")
    own = json.loads(report.read_text())["objects"][0]["dials"]["own"]
    assert own["text"].startswith("Tiles; ") and own["height"] == 0.5


def test_tiles_are_over_all_objects_of_a_file(tmp_path):
    for scale in (1.0, 2.0):
        mesh_object(f"Limb {scale}", *limb_arrays()).scale = (scale, scale, scale)
    blend, report = saved(tmp_path / "limbs.blend"), tmp_path / "report.json"
    pressed_here("--report", report, "--press", "tile", "--set", "tiles=300", blend=blend)
    tilings = [entry["components"][0]["tiling"] for entry in json.loads(report.read_text())["objects"]]
    assert len(tilings) == 2 and sum(tiling["tiles"] for tiling in tilings) == pytest.approx(300, rel=0.1)


@needs_program
def test_a_script_in_the_file_does_not_run(tmp_path):
    """With --disable-autoexec, as the documentation has it, whoever opens the file; with --enable-autoexec it does."""
    torus("Ring")
    script, mark = bpy.data.texts.new("script.py"), tmp_path / "ran"
    script.write(f"open({str(mark)!r}, 'w')")
    script.use_module = True
    blend = saved(tmp_path / "file.blend")
    assert headless(blend=blend).returncode == 0 and headless(blend).returncode == 0
    assert not mark.exists()
    subprocess.run([BLENDER, "-b", "--factory-startup", "--enable-autoexec", str(blend)], check=True)
    assert mark.exists()


def test_a_link_is_of_the_kind_that_its_own_name_says(torus_file, tmp_path):
    """The file that is replaced, where the link stays."""
    replaced, output = tmp_path / "other blob", tmp_path / "out.blend"
    replaced.write_bytes(b"old")
    output.symlink_to(replaced)
    pressed_here(torus_file, "--output", output, "--report", tmp_path / "report.json")
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
    assert "interrupted; files already written are complete" in said
    with bpy.data.libraries.load(str(output)) as (there, _):
        assert there.objects == ["ring"]
