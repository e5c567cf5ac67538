"""A whole scene through files of exchange by the headless command: no more is lost than by Blender's own exporters,
with those options with which they lose least."""

import bpy
import full_scene
import pytest
from exchange_formats import SCENES, may_write_gltf
from headless_runs import headless
from loaded_addon import module
from scenes import grid_arrays, mesh_object

compatibility, exchange = module("compatibility"), module("command_line.exchange")
IMPORTERS = module("native").module("files.formats").IMPORTERS
BEST = {
    ".glb": {
        "export_cameras": True,
        "export_lights": True,
        "export_extras": True,
        "export_vertex_color": "ACTIVE",
        "export_all_influences": True,
        "export_attributes": True,
        "use_mesh_edges": True,
        "use_mesh_vertices": True,
    },
    ".fbx": {"use_custom_props": True, "path_mode": "COPY", "embed_textures": True, "use_mesh_edges": True},
    ".usdc": {"export_animation": True, "rename_uvmaps": False, "use_instancing": True},
}
MAPS = ("--main", "balanced", "--forms", 0)
FEW = 0.25  # part of all facts: what Blender's own exporters lose


def operators(path):
    """Blender's importer and exporter."""
    if path.suffix == ".glb":
        return bpy.ops.import_scene.gltf, bpy.ops.export_scene.gltf
    if path.suffix == ".fbx":
        return compatibility.operator(IMPORTERS[".fbx"]), bpy.ops.export_scene.fbx
    return bpy.ops.wm.usd_import, bpy.ops.wm.usd_export


def write(path):
    exporter = operators(path)[1]
    known = exporter.get_rna_type().properties.keys()
    exporter(filepath=str(path), **{name: value for name, value in BEST[path.suffix].items() if name in known})


def read(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with compatibility.old_numpy_names():
        operators(path)[0](filepath=str(path))


def facts(path):
    read(path)
    return full_scene.facts()


@pytest.fixture
def source(tmp_path):
    """(facts of an empty scene, facts of the full one, its file)"""
    nothing = full_scene.facts()
    full_scene.make()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    return nothing, full_scene.facts(), tmp_path / "scene.blend"


@pytest.mark.parametrize("suffix", SCENES)
def test_no_more_is_lost_than_by_blenders_own_export(suffix, source, tmp_path):
    """From a .blend file, and from a file of the same format."""
    nothing, whole, blend = source
    own, ours, own_again, ours_again = (tmp_path / f"{name}{suffix}" for name in ("own", "ours", "own_2", "ours_2"))
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    write(own)
    for done in (headless("--output", ours, *MAPS, blend=blend), headless(own, "--output", ours_again, *MAPS)):
        assert done.returncode == 0, done.stderr
    by_own = full_scene.lost(whole, facts(own))
    read(own)
    write(own_again)
    assert len(by_own) < FEW * len(full_scene.lost(whole, nothing))
    assert full_scene.lost(whole, facts(ours)) <= by_own
    assert full_scene.lost(whole, facts(ours_again)) <= by_own | full_scene.lost(whole, facts(own_again))


@pytest.mark.parametrize("suffix", SCENES)
def test_nothing_of_ours_is_in_the_file_but_the_map(suffix, tmp_path):
    """Also of objects that are in the scene by instances alone, and of earlier runs."""
    full_scene.make()
    prop = bpy.data.objects["Prop"]
    for owner in (prop, prop.data, bpy.data.objects["Instance 0"]):
        owner["holomorph_report"] = "{}"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    out = tmp_path / f"out{suffix}"
    assert headless("--output", out, *MAPS, blend=tmp_path / "scene.blend").returncode == 0
    read(out)
    owners = [*bpy.data.objects, *bpy.data.meshes, *bpy.data.materials, *bpy.data.scenes]
    names = [name for owner in owners for name in owner.keys()]  # noqa: SIM118  no dictionary
    names += [entry.name for entry in (*bpy.data.materials, *bpy.data.images, *bpy.data.texts)]
    assert not [name for name in names if "holomorph" in name.lower()]


@pytest.mark.parametrize("suffix", SCENES)
def test_the_texture_is_in_the_file_where_it_is_asked_for(suffix, tmp_path):
    """In place of the materials, by a picture that the importer finds on the map of ours."""
    sheet = mesh_object("Sheet", *grid_arrays(4))
    sheet.data.materials.append(bpy.data.materials.new("Own"))
    sheet.data.uv_layers.new(name="UVMap")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    out = tmp_path / f"out{suffix}"
    options = ("--texture", "bricks" if suffix == ".glb" else "checker", "--export-texture", *MAPS)
    done = headless("--output", out, *options, blend=tmp_path / "scene.blend")
    assert done.returncode == 0, done.stderr
    read(out)
    (shown,) = [obj.material_slots[0].material for obj in bpy.data.objects if obj.type == "MESH"]
    (picture,) = [node for node in shown.node_tree.nodes if node.type == "TEX_IMAGE"]
    assert picture.outputs["Color"].links[0].to_socket.name == "Base Color" and min(picture.image.size) > 100
    assert len(set(picture.image.pixels[:4000])) > 3


@pytest.mark.parametrize("suffix", SCENES)
def test_what_modifiers_make_is_written(suffix, tmp_path):
    half = mesh_object("Half", *grid_arrays(4))
    half.location.x = 1
    half.modifiers.new("Mirror", "MIRROR")
    exchange.write(tmp_path / f"out{suffix}")
    read(tmp_path / f"out{suffix}")
    assert full_scene.boxes()[0][[0, 3]] == pytest.approx([-3, 5], abs=1e-4)


@may_write_gltf
def test_shapes_of_bones_are_no_part_of_the_scene(source, tmp_path):
    """Blender's importer of glTF files makes meshes for its own use: they are not mapped, and not written."""
    bpy.ops.wm.open_mainfile(filepath=str(source[2]))
    write(tmp_path / "own.glb")
    meshes = {obj.name for obj in bpy.context.scene.objects if obj.type == "MESH"} | {"Prop"}
    bpy.ops.wm.read_factory_settings(use_empty=True)
    read_here = {obj.name.split(".")[0] for obj in exchange.read(tmp_path / "own.glb", "Y")}
    assert read_here == meshes
    exchange.write(tmp_path / "out.fbx")
    read(tmp_path / "out.fbx")
    assert {obj.name.split(".")[0] for obj in bpy.data.objects if obj.type == "MESH"} == meshes
