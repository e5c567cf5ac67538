"""What batches have Blender do with files of other programs: objects become arrays, maps go into .blend files."""

import importlib
import io
import json
import sys

import bpy
import numpy as np
import pytest
from exchange_formats import SCENES, write
from headless_runs import BLENDER
from loaded_addon import module
from scenes import mesh_io, native, torus, torus_arrays, uv_maps

compatibility = module("compatibility")
AS_PROGRAM = """#!{python}
# What a Blender program does with a batch's arguments, by Blender as a Python module.
import os, runpy, sys, bpy
words = sys.argv[1 : sys.argv.index("--")]
for word in words:
    if word.endswith(".blend"):
        bpy.ops.wm.open_mainfile(filepath=word)
runpy.run_path(words[words.index("--python") + 1], run_name="__main__")
sys.stdout.flush()
os._exit(0)
"""


@pytest.fixture
def program(tmp_path):
    if BLENDER:
        return BLENDER
    path = tmp_path / "blender"
    path.write_text(AS_PROGRAM.format(python=sys.executable))
    path.chmod(0o755)
    return str(path)


def batch_modules(*names):
    """Modules of the package that the add-on uses."""
    return [importlib.import_module(f"{native.load().__name__}.batch.{name}") for name in names]


def ring_with_seams():
    """A smooth ring, twice as high as its mesh, with a map: glTF splits its vertices along the seams of that alone."""
    ring = torus("Ring")
    ring.scale.z = 2
    mesh_io.write_values(compatibility.Values(ring.data.polygons, "use_smooth", bool), np.ones(24 * 12, bool))
    corners = np.indices((24, 12)).reshape(2, -1).T[:, None] + [(0, 0), (1, 0), (1, 1), (0, 1)]
    uv = (corners / (24, 12)).reshape(-1, 2).astype(np.float32)
    mesh_io.write_values(compatibility.uv_values(ring.data.uv_layers.new(name="UVMap")), uv)
    camera = bpy.data.objects.new("Eye", bpy.data.cameras.new("Eye"))
    bpy.context.scene.collection.objects.link(camera)


@pytest.mark.parametrize("suffix", SCENES)
def test_a_file_of_another_program_is_read_and_its_map_is_written(suffix, program, tmp_path):
    """The seams of a map are not boundaries. The .blend file is the scene that the file holds."""
    library = native.load()
    recipe, task = (importlib.import_module(f"{library.__name__}.batch.{n}") for n in ("recipe", "task"))
    ring_with_seams()
    path, folder = tmp_path / f"scene{suffix}", tmp_path / "opened"
    write(path)
    folder.mkdir()
    record, files = task.Task("scene", "key", path, 1, folder, tmp_path, blender=program).run()
    assert record["status"] == "done", record["message"]
    for name, content in files.items():
        (folder / name).write_bytes(content)
    ((name, arrays, corners),) = task.objects(folder)
    options = recipe.of({"maps": {"main": "balanced"}, "output": {"formats": ["npz", "blend"]}})
    record, files = task.Task(
        name, "key", arrays, corners, tmp_path, tmp_path, options, (str(path), name), program
    ).run()
    assert record["status"] == "done", record["message"]
    assert [part["genus"] for part in json.loads(files["report.json"])["components"]] == [1]
    (tmp_path / "out.blend").write_bytes(files["mesh.blend"])
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "out.blend"))
    assert [obj.name for obj in bpy.data.objects if obj.type == "CAMERA"]
    written, made = uv_maps.read_map(bpy.data.objects[name].data, "Holomorphic"), np.load(io.BytesIO(files["mesh.npz"]))
    assert (written == made["uv"].astype(np.float32)).all() and np.ptp(written) > 0.1
    assert np.ptp(made["vertices"], axis=0)[2] == pytest.approx(2 * np.ptp(torus_arrays()[0], axis=0)[2], rel=1e-4)
