"""Files of other programs through the headless command: objects, materials and UV maps are kept."""

import json

import bpy
import numpy as np
import pytest
from exchange_formats import may_write_gltf, needs_usd
from headless_runs import headless, our_lines, write_obj
from loaded_addon import module
from picked_faces import add_own_map
from scenes import grid_arrays, mesh_io, select, torus, torus_arrays, uv_maps

exchange = module("command_line.exchange")
holomorph = module("native").load()
FORMATS = [
    *(pytest.param(suffix, marks=may_write_gltf) for suffix in (".glb", ".gltf")),
    ".fbx",
    ".obj",
    pytest.param(".usdc", marks=needs_usd),
]
NEAR = 1e-5


def scene():
    """A torus with two materials and an own map, and a sheet; in places of their own."""
    ring = torus("Ring")
    sheet_arrays = grid_arrays()
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata([tuple(v) for v in sheet_arrays[0]], [], [tuple(f) for f in sheet_arrays[1]])
    sheet = bpy.data.objects.new("Sheet", mesh)
    bpy.context.scene.collection.objects.link(sheet)
    sheet.location = (5, 0, 0)
    for obj in (ring, sheet):
        add_own_map(obj, "UVMap")
    for name in ("Red", "Green"):
        ring.data.materials.append(bpy.data.materials.new(name))
    sheet.data.materials.append(bpy.data.materials["Red"])
    mesh_io.write_values(
        module("compatibility").Values(ring.data.polygons, "material_index", np.int32), np.arange(288) % 2
    )
    select(ring, sheet)
    return ring, sheet


def file_of(folder, suffix):
    path = folder / f"scene{suffix}"
    scene()
    exchange.write(path)
    return path


def read_back(path):
    """{name: object} of a written file."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    return {obj.name.split(".")[0]: obj for obj in exchange.read(path, "Y")}


def map_values(mesh):
    """The maps as sorted rows: importers number corners as they like."""
    return [np.sort(uv_maps.read_map(mesh, layer.name).round(4), axis=0) for layer in mesh.uv_layers]


@pytest.mark.parametrize("suffix", FORMATS)
def test_through_the_command_and_back(suffix, tmp_path):
    source, out, report = file_of(tmp_path, suffix), tmp_path / f"out{suffix}", tmp_path / "report.json"
    before = {name: map_values(obj.data)[0] for name, obj in read_back(source).items()}
    done = headless(source, "--output", out, "--report", report, "--main", "balanced", "--forms", 0)
    assert done.returncode == 0, done.stderr
    entries = {entry["object"].split(".")[0]: entry for entry in json.loads(report.read_text())["objects"]}
    assert {name: entry["components"][0]["genus"] for name, entry in entries.items()} == {"Ring": 1, "Sheet": 0}
    found = read_back(out)
    assert set(found) == {"Ring", "Sheet"}
    used = {
        name: sorted(slot.material.name.split(".")[0] for slot in obj.material_slots) for name, obj in found.items()
    }
    assert used == {"Ring": ["Green", "Red"], "Sheet": ["Red"]}
    for name, obj in found.items():
        maps = map_values(obj.data)
        if suffix == ".obj":  # which has one map: ours
            assert len(maps) == 1 and not np.allclose(maps[0], before[name], atol=1e-3)
        else:
            own = obj.data.uv_layers.find("UVMap")  # USD sorts by name
            assert len(maps) == 2 and np.allclose(maps[own], before[name], atol=1e-3)
            maps.pop(own)
        assert np.ptp(maps[0]) > 0.1 and maps[0].min() > -NEAR and maps[0].max() < 1 + NEAR
    assert found["Sheet"].matrix_world.translation.x == pytest.approx(5 if suffix != ".obj" else 0, abs=1e-4)


@may_write_gltf
def test_a_gltf_file_keeps_its_vertices_and_is_mapped_as_one(tmp_path):
    """Vertices that the format splits, here at each corner, are joined for the maps alone."""
    scene()
    exchange.write(tmp_path / "scene.glb")
    found, report = read_back(tmp_path / "scene.glb"), tmp_path / "report.json"
    count = len(found["Ring"].data.vertices)
    assert count > len(torus_arrays()[0])
    done = headless(tmp_path / "scene.glb", "--object", "Ring", "--output", tmp_path / "out.blend", "--report", report)
    assert done.returncode == 0, done.stderr
    (entry,) = json.loads(report.read_text())["objects"]
    assert [(part["genus"], part["boundary_count"]) for part in entry["components"]] == [(1, 0)]
    assert entry["repairs"]["joined_vertices"]["count"] == count - len(torus_arrays()[0])
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "out.blend"))
    assert len(bpy.data.objects["Ring"].data.vertices) == count


@pytest.mark.parametrize("line", ["vt 0 0", "usemtl Red", "vt\t0 0", "  usemtl\tRed", "v 0 0 0 1 0 0", "o a\no b"])
def test_what_of_obj_files_blender_reads(line, tmp_path):
    """What the package's reader, which tokenises the file, does not give."""
    path = write_obj(tmp_path / "ring.obj", *torus_arrays())
    read = module("native").module("mesh.intake").read
    assert not read(path).has_more
    path.write_text(path.read_text() + f"# a\n{line}\n")
    assert read(path).has_more


def test_what_a_reader_notes_is_told(tmp_path):
    """A file without its last lines is mapped all the same."""
    path = tmp_path / "ring.stl"
    vertices, faces = torus_arrays()
    holomorph.Surface(vertices, faces).write(tmp_path / "ring.ply")
    text = "solid a\n"
    for a, b, c in holomorph.Surface(vertices, faces).triangles.tolist():
        text += "facet normal 0 0 1\nouter loop\n"
        text += "".join("vertex {!r} {!r} {!r}\n".format(*map(float, vertices[v])) for v in (a, b, c))
        text += "endloop\nendfacet\n"
    path.write_text(text)
    done = headless(path, "--output", tmp_path / "out.blend")
    assert done.returncode == 0, done.stderr
    assert any("the file ends before 'endsolid'" in line for line in our_lines(done))


@may_write_gltf
def test_one_object_of_a_file(tmp_path):
    report = tmp_path / "report.json"
    done = headless(file_of(tmp_path, ".glb"), "--object", "Sheet", "--report", report)
    assert done.returncode == 0, done.stderr
    assert [entry["object"] for entry in json.loads(report.read_text())["objects"]] == ["Sheet"]


@may_write_gltf
def test_the_picture_is_no_part_of_the_file(tmp_path):
    out, picture = tmp_path / "out.glb", tmp_path / "picture.png"
    small = ("--render", picture, "--resolution", 32, "--samples", 1)
    assert headless(file_of(tmp_path, ".glb"), "--output", out, *small).returncode == 0
    assert picture.is_file() and set(read_back(out)) == {"Ring", "Sheet"}


@pytest.mark.parametrize("suffix", [".glb", ".fbx"])
def test_a_broken_file_is_one_sentence_and_has_a_report(suffix, tmp_path):
    path, report, out = tmp_path / f"broken{suffix}", tmp_path / "report.json", tmp_path / "out.blend"
    path.write_bytes(b"nothing of the kind")
    done = headless(path, "--report", report, "--output", out)
    assert done.returncode == 1 and len(our_lines(done)) == 1 and "Traceback" not in our_lines(done)[0]
    (entry,) = json.loads(report.read_text())["objects"]
    assert entry["object"] == "broken" and not entry["done"] and str(path) in entry["refused"]
    assert not out.exists()


def test_a_file_that_is_refused_has_a_report(tmp_path):
    path, report = write_obj(tmp_path / "bad.obj", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 5)]), tmp_path / "r.json"
    assert headless(path, "--report", report).returncode == 1
    (entry,) = json.loads(report.read_text())["objects"]
    assert entry["object"] == "bad" and not entry["done"] and entry["refused"]


@may_write_gltf
def test_a_file_without_a_mesh(tmp_path):
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Nothing", None))
    exchange.write(tmp_path / "empty.glb")
    with pytest.raises(exchange.ExchangeError, match="no mesh"):
        exchange.read(tmp_path / "empty.glb", "Y")


def test_usd_where_there_is_none(tmp_path, monkeypatch):
    monkeypatch.setattr(module("compatibility"), "is_there", lambda _operator: False)
    with pytest.raises(exchange.ExchangeError, match="this Blender cannot write USD"):
        exchange.write(tmp_path / "scene.usdc")


def rich_scene():
    """A torus with the map of its form, an animated shape key and a custom property, a camera and a light."""
    ring = torus("Ring")
    bpy.ops.uv.holomorphic_maps(main="BALANCED", forms=1)
    ring["wheel"] = 7
    ring.shape_key_add(name="Basis")
    key = ring.shape_key_add(name="Bent")
    key.data[3].co.z += 1
    for frame, value in ((1, 0.0), (20, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    for data in (bpy.data.cameras.new("Camera"), bpy.data.lights.new("Lamp", "POINT")):
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(data.name, data))
    return ring


@pytest.mark.parametrize("suffix", [f for f in FORMATS if f != ".obj"])
@pytest.mark.parametrize("forms", [False, True])
def test_what_exporters_leave_out_by_default_is_kept_and_forms_on_demand(suffix, forms, tmp_path):
    rich_scene()
    exchange.write(tmp_path / f"rich{suffix}", forms)
    found = read_back(tmp_path / f"rich{suffix}")
    assert {"MESH", "CAMERA", "LIGHT"} <= {obj.type for obj in bpy.data.objects}
    ring = found["Ring"]
    assert len(ring.data.uv_layers) == (2 if forms else 1)
    owners = [*bpy.data.objects, ring.data]  # USD has objects with shape keys below an empty, which has the properties
    own = [name for owner in owners for name in owner.keys()]  # noqa: SIM118  no dictionary
    assert any(name.endswith("wheel") for name in own) and not any("holomorph" in name for name in own)
    bent = ring.data.shape_keys.key_blocks["Bent"]
    bpy.context.scene.frame_set(1)
    first = bent.value
    bpy.context.scene.frame_set(20)
    assert abs(bent.value - first) > 0.5
