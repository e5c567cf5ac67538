"""Objects of .blend files: read by Blender, mapped without it, written back by it."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from batch_runs import SECONDS, run, statuses

BLENDER = os.environ.get("HOLOMORPH_BLENDER") or shutil.which("blender")
pytestmark = pytest.mark.skipif(not BLENDER, reason="no Blender program")
MAKE = """
import bpy, sys
bpy.ops.wm.read_factory_settings(use_empty=True)
for number, name in enumerate(("Ring", "A/B")):
    bpy.ops.mesh.primitive_torus_add(major_segments=24, minor_segments=12, location=(3 * number, 0, 0))
    bpy.context.object.name = name
    bpy.context.object.scale = (1, 1, 2)
bpy.ops.object.empty_add()
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[-1])
"""
LOOK = """
import bpy, json, sys
found = {}
for obj in bpy.data.objects:
    if obj.type == "MESH":
        uv = obj.data.uv_layers.get("Holomorphic")
        values = [0.0] * (2 * len(obj.data.loops))
        if uv:
            uv.data.foreach_get("uv", values)
        found[obj.name] = [len(obj.data.polygons), bool(uv and uv.active), values]
open(sys.argv[-1], "w").write(json.dumps(found))
"""


def in_blender(script, *arguments, file=()):
    command = [BLENDER, "-b", "--factory-startup", *map(str, file), "--python-exit-code", "3", "--python-expr", script]
    subprocess.run([*command, "--", *map(str, arguments)], capture_output=True, timeout=SECONDS, check=True)


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    folder = tmp_path_factory.mktemp("blend")
    in_blender(MAKE, folder / "scene.blend")
    (folder / "broken.blend").write_bytes(b"BLENDER-v304 and nothing more")
    (folder / "recipe.toml").write_text("[maps]\nmain = 'balanced'\n[output]\nformats = ['npz', 'blend']\n")
    files = [folder / "scene.blend", folder / "broken.blend"]
    arguments = (*files, "--out", folder / "out", "--recipe", folder / "recipe.toml", "--blender", BLENDER)
    return folder, run(*arguments), arguments


def test_each_object_is_an_asset(done):
    folder, result, _ = done
    assert result.returncode == 1 and "3 assets: 2 done, 1 refused" in result.stdout, result.stderr
    assert "broken.blend: refused: Blender exited with" in result.stderr
    assert statuses(folder / "out") == {"scene.blend/Ring": "done", "scene.blend/A%2FB": "done"}


def test_the_scale_counts(done):
    """As the mesh is seen: twice as high as it is in its own frame, 0.5 of the minor radius."""
    arrays = np.load(done[0] / "out/assets/scene.blend/Ring/mesh.npz")
    assert np.ptp(arrays["vertices"], axis=0) == pytest.approx([2.5, 2.5, 1.0], rel=1e-6)


def test_maps_are_in_the_file(done):
    """In single precision; the other object keeps its own map."""
    import json

    folder = done[0]
    in_blender(LOOK, folder / "found.json", file=[folder / "out/assets/scene.blend/Ring/mesh.blend"])
    found = json.loads(Path(folder / "found.json").read_text())
    arrays = np.load(folder / "out/assets/scene.blend/Ring/mesh.npz")
    faces, is_active, values = found["Ring"]
    assert faces == 24 * 12 and is_active
    assert (np.reshape(values, (-1, 2)) == arrays["uv"].astype(np.float32)).all()
    assert not found["A/B"][1]


def test_a_second_run_needs_no_blender_process(done):
    folder, _, arguments = done
    before = {path: path.stat().st_mtime_ns for path in (folder / "out/.blend").rglob("*.npz")}
    assert run(*arguments).returncode == 1
    assert {path: path.stat().st_mtime_ns for path in (folder / "out/.blend").rglob("*.npz")} == before


EXPORT = """
import bpy, sys
import numpy as np
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.mesh.primitive_torus_add(major_segments=24, minor_segments=12)
bpy.context.object.name = "Ring"
bpy.ops.object.camera_add()
bpy.ops.export_scene.gltf(filepath=sys.argv[-2], export_format="GLB")
bpy.ops.export_scene.fbx(filepath=sys.argv[-1])
"""


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    """A folder with files of other programs alone, one of them broken, and the result of its batch."""
    folder = tmp_path_factory.mktemp("imported")
    (folder / "in").mkdir()
    in_blender(EXPORT, folder / "in/ring.glb", folder / "in/ring.fbx")
    (folder / "in/broken.glb").write_bytes(b"glTF and nothing more")
    (folder / "recipe.toml").write_text("[maps]\nmain = 'balanced'\n[output]\nformats = ['npz', 'blend']\n")
    recipe = "--recipe", folder / "recipe.toml"
    return folder, run(folder / "in", "--out", folder / "out", *recipe, "--blender", BLENDER)


def test_files_of_other_programs_are_scenes(imported):
    folder, result = imported
    assert result.returncode == 1 and "3 assets: 2 done, 1 refused" in result.stdout, result.stderr
    assert "broken.glb: refused: " in result.stderr
    assert statuses(folder / "out") == {"ring.glb/Ring": "done", "ring.fbx/Ring": "done"}


@pytest.mark.parametrize("scene", ["ring.glb", "ring.fbx"])
def test_maps_go_to_a_blend_file_of_what_was_imported(imported, scene):
    folder, _ = imported
    asset = folder / "out/assets" / scene / "Ring"
    in_blender(LOOK, folder / "found.json", file=[asset / "mesh.blend"])
    faces, is_active, values = json.loads((folder / "found.json").read_text())["Ring"]
    assert faces and is_active and any(values)
