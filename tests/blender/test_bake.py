"""Baking tilings: the atlas shows what the tiling shows, its margins are kept, and nothing else is changed."""

import json

import bpy
import numpy as np
import pytest
from baked_images import Points, covering, grown, islands, pixels, sampled
from file_state import differences, file_state
from headless_runs import pressed_here, refusal, sets
from loaded_addon import module
from scenes import grid_arrays, mesh_object, select, torus, uv_maps

bake, material = module("baking.bake"), module("materials.material")
STEP = 1 / 255  # of a channel
SIDE = 64  # pixels of the smooth picture
BRIGHT = 0.25  # the least of it
WAVES = np.array([[1, 0], [0, 2], [1, 1]])  # of its channels
ONLY_COLOUR = {"COLOUR"}


def picture():
    """An image of one wave in each channel, nowhere black."""
    at = (np.arange(SIDE) + 0.5) / SIDE
    u, v = np.meshgrid(at, at)
    waves = [np.sin(2 * np.pi * (m * u + n * v)) for m, n in WAVES]
    values = np.ones((SIDE, SIDE, 4), np.float32)
    values[..., :3] = (1 + BRIGHT) / 2 + (1 - BRIGHT) / 2 * np.stack(waves, axis=-1)
    image = bpy.data.images.new("Picture", SIDE, SIDE)
    image.pixels.foreach_set(values.ravel())
    image.pack()
    return image


def slope():
    """The most that a channel of the picture changes for a UV unit."""
    return np.pi * (1 - BRIGHT) * np.linalg.norm(WAVES, axis=1).max()


def own_material(name="Own", image=None, colour=(0.8, 0.2, 0.1, 1.0), **values):
    """One that reads the tiling by its name."""
    made = bpy.data.materials.new(name)
    tree = module("compatibility").enable_nodes(made)
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = colour
    for key, value in values.items():
        shader.inputs[key].default_value = value
    if image is not None:
        by_name, texture = tree.nodes.new("ShaderNodeUVMap"), tree.nodes.new("ShaderNodeTexImage")
        by_name.uv_map, texture.image = "Holomorphic", image
        tree.links.new(by_name.outputs[0], texture.inputs["Vector"])
        tree.links.new(texture.outputs[0], shader.inputs["Base Color"])
    return made


def tiled(obj, **options):
    """With the tiling; the material is its own, or ours for a texture."""
    select(obj)
    assert bpy.ops.uv.holomorphic_tile(tiles=24, checker="texture" in options, **options) == {"FINISHED"}
    return obj


def scene(image=None):
    """A torus that gets islands of Blender's, and a box that unfolds; each with its own material."""
    image = image or picture()
    box = mesh_object("Box", *box_arrays())
    box.scale, box.location = (1.0, 1.5, 1.0), (4, 0, 0)
    found = [torus("Torus"), box]
    for obj in found:
        obj.data.materials.append(own_material(f"Own {obj.name}", image))
        tiled(obj)
    select(*found)
    return found


def box_arrays(count=4):
    """Quads of a box without a lid."""
    vertices, faces = grid_arrays(count)
    vertices = vertices / count * (2, 2, 0)
    sides = []
    for k in range(4):
        turn = np.array([[0, -1], [1, 0]])
        wall = vertices[:, [0, 2, 1]] - (1, 0, 0)
        wall[:, 1] = -1
        xy = wall[:, :2] @ np.linalg.matrix_power(turn, k).T
        sides.append(np.column_stack([xy, wall[:, 2]]))
    every = np.concatenate([(vertices - (1, 1, 0)), *sides]).round(9)
    number = len(vertices)
    all_faces = np.concatenate([faces[:, ::-1], *(faces + (k + 1) * number for k in range(4))])
    unique, place = np.unique(every, axis=0, return_inverse=True)
    return unique, place.reshape(-1)[all_faces]


def run(**options):
    return bpy.ops.object.holomorphic_bake(**{"texels": 40.0, "channels": ONLY_COLOUR, "margin": 4} | options)


def image_of(name):
    return bpy.data.images[name]


@pytest.mark.parametrize("images", ["EACH", "ONE"])
def test_the_atlas_shows_what_the_tiling_shows(images):
    found, picture_pixels = scene(), pixels(image_of("Picture"))
    assert run(images=images) == {"FINISHED"}
    for obj in found:
        baked = image_of("Torus Atlas Colour" if images == "ONE" else f"{obj.name} Colour")
        atlas, points = pixels(baked), Points(obj)
        texel = 1 / baked.size[0]
        error = np.abs(sampled(atlas, points.bake, False) - sampled(picture_pixels, points.tiling)).max(axis=1)
        # A filter takes in values a diagonal away; at borders those of margins, which are filtered themselves.
        reach, stretch = slope() * np.sqrt(2) * texel, points.stretch()
        assert (error <= reach * stretch + 2 * STEP).mean() > 0.995
        assert (error <= 2 * reach * stretch.max() + 2 * STEP).all() and np.median(error) < 4 * STEP
        assert points.in_middles(baked.size[0]) > 1000
        error = np.abs(sampled(atlas, points.bake, False) - sampled(picture_pixels, points.tiling))
        assert error.max() < 2 * STEP  # there the bake is not a filter


def test_the_textures_are_baked_exactly():
    obj = tiled(torus(), texture="BRICKS")
    assert run(texels=60.0) == {"FINISHED"}
    tree = obj.data.materials[0].node_tree
    assert tree.nodes["Checker Map"].uv_map == uv_maps.bake_map(obj.data) == "Holomorphic Bake"
    baked, points = image_of("Torus Colour"), Points(obj)
    points.in_middles(baked.size[0])
    shown = bpy.data.materials["Holomorphic Bricks (turned)"].node_tree.nodes["Repeats"].outputs[0].default_value
    wanted = sampled(pixels(image_of("Holomorph Bricks")), points.tiling * shown)
    error = np.abs(sampled(pixels(baked), points.bake, False) - wanted).max(axis=1)
    assert np.quantile(error, 0.99) < 3 * STEP and error.max() < 0.1


@pytest.mark.parametrize("margin", [2, 5])
def test_islands_are_apart_and_margins_show_their_border(margin):
    scene()
    for name, colour in (("Torus", (1, 0, 0, 1)), ("Box", (0, 1, 0, 1))):
        obj = bpy.data.objects[name]
        obj.data.materials[0] = own_material(f"Plain {name}", colour=colour)
    assert run(images="ONE", margin=margin) == {"FINISHED"}
    baked = pixels(image_of("Torus Atlas Colour"))
    side, covered = len(baked), {}
    for name, channel in (("Torus", 0), ("Box", 1)):
        count = covering(bpy.data.objects[name], side)
        assert count.max() == 1  # nothing overlaps
        covered[name] = count > 0
        near = grown(covered[name], margin)
        assert np.allclose(baked[near], np.eye(3)[channel], atol=STEP)
    assert not (covered["Torus"] & covered["Box"]).any()
    labels, number = islands(grown(covered["Torus"] | covered["Box"], 1))  # middles on edges are in no triangle
    assert number > 2
    for label in range(1, number + 1):
        assert not (grown(labels == label, 2 * margin - 1) & (labels != label) & (labels > 0)).any()


def test_channels():
    obj = torus()
    made = own_material(Roughness=0.3, Metallic=0.7)
    tree = made.node_tree
    bump = tree.nodes.new("ShaderNodeBump")
    bump.inputs["Height"].default_value = 2.5  # as no image of bytes could hold it
    tree.links.new(bump.outputs[0], next(n for n in tree.nodes if n.type == "BSDF_PRINCIPLED").inputs["Normal"])
    obj.data.materials.append(made)
    tiled(obj)
    assert run(channels={"COLOUR", "ROUGHNESS", "METALLIC", "HEIGHT", "NORMAL"}, texels=20.0) == {"FINISHED"}
    middle = covering(obj, image_of("Torus Colour").size[0]) > 0
    for name, value in (("Roughness", 0.3), ("Metallic", 0.7), ("Height", 2.5)):
        image = image_of(f"Torus {name}")
        assert image.colorspace_settings.name == "Non-Color" and image.packed_file
        assert np.allclose(pixels(image)[middle], value, atol=STEP)
    assert image_of("Torus Height").is_float and image_of("Torus Colour").colorspace_settings.name == "sRGB"
    assert np.allclose(pixels(image_of("Torus Normal"))[middle], (0.5, 0.5, 1), atol=0.05)  # quads are not flat
    nodes = obj.material_slots[0].material.node_tree.nodes
    assert nodes["Roughness"].outputs[0].links[0].to_socket.name == "Roughness"
    assert next(n for n in nodes if n.type == "NORMAL_MAP").uv_map == uv_maps.bake_map(obj.data)


def test_a_relief_is_in_the_normals():
    obj = tiled(torus(), texture="BRICKS")
    assert run(channels={"NORMAL"}) == {"FINISHED"}
    middle = covering(obj, image_of("Torus Normal").size[0]) > 0
    assert np.ptp(pixels(image_of("Torus Normal"))[middle][:, :2], axis=0).min() > 0.1


def left():
    """The state of the file, but for the users of images: Blender 3.4 counts one more for each copy of a material."""
    return {
        path: value for path, value in file_state().items() if not path.startswith("images") or path[-5:] != "users"
    }


def settings():
    """What of the scene a bake could leave changed."""
    state = file_state()
    wanted = ("scenes", "selected", "hidden", "mode", "objects[Torus].hide", "cameras", "lights", "worlds")
    return {path: value for path, value in state.items() if path.startswith(wanted)}


def test_the_scene_stays_as_it_is():
    first, second = scene()
    second.hide_render = True
    bpy.context.scene.render.bake.margin = 3
    before, blocks = settings(), counts()
    assert run() == {"FINISHED"}
    assert not differences(before, settings())
    assert bpy.context.view_layer.objects.active == first and second.hide_render
    after = counts()
    assert after.pop("materials") == blocks.pop("materials") + 2 and after.pop("images") == blocks.pop("images") + 2
    assert after == blocks


def counts():
    return {kind: len(getattr(bpy.data, kind)) for kind in ("objects", "meshes", "scenes", "materials", "images")}


def test_materials_come_back():
    obj = torus()
    obj.data.materials.append(own_material())
    tiled(obj, texture="BRICKS")
    before = file_state()
    bricks = obj.material_slots[0].material
    assert run() == {"FINISHED"}
    assert material.is_baked(obj.material_slots[0].material)
    assert bpy.ops.uv.holomorphic_restore_materials() == {"FINISHED"}
    assert obj.material_slots[0].material == bricks and obj.data.uv_layers.active.name == "Holomorphic"
    of_object = {path: value for path, value in file_state().items() if path.startswith("objects[")}
    assert not differences({path: value for path, value in before.items() if path.startswith("objects[")}, of_object)
    assert bpy.ops.uv.holomorphic_restore_materials() == {"FINISHED"}
    assert obj.material_slots[0].material.name == "Own" and obj.material_slots[0].link == "DATA"


def test_own_materials_come_back():
    first, second = scene()
    assert run(images="ONE") == {"FINISHED"}
    assert first.material_slots[0].material == second.material_slots[0].material
    assert bpy.ops.uv.holomorphic_restore_materials() == {"FINISHED"}
    assert [obj.material_slots[0].material.name for obj in (first, second)] == ["Own Torus", "Own Box"]


def test_a_second_bake_is_of_the_tiling_and_replaces_the_first():
    obj = tiled(torus(), texture="BRICKS")
    assert run() == {"FINISHED"}
    first, blocks = pixels(image_of("Torus Colour")), counts()
    assert run() == {"FINISHED"}
    assert counts() == blocks and len(obj.data.uv_layers) == 2
    assert np.array_equal(pixels(image_of("Torus Colour")), first)


def test_maps_are_removed_with_the_map_of_the_bake():
    obj = tiled(torus(), texture="BRICKS")
    run()
    tiled(obj, texture="BRICKS")
    assert {layer.name for layer in obj.data.uv_layers} == {"Holomorphic", "Holomorphic Bake"}
    assert bpy.ops.uv.holomorphic_remove_maps() == {"FINISHED"}
    assert not obj.data.uv_layers and not obj.material_slots
    assert not [name for name in (*obj.keys(), *obj.data.keys()) if name.startswith("holomorph")]


def test_objects_that_share_a_mesh_show_one_bake():
    obj = tiled(torus(), texture="BRICKS")
    other = obj.copy()
    bpy.context.scene.collection.objects.link(other)
    select(obj, other)
    assert run() == {"FINISHED"}
    assert obj.material_slots[0].material == other.material_slots[0].material == bpy.data.materials["Torus Baked"]


def test_udim_tiles(tmp_path):
    first, second = scene()
    assert run(images="UDIM", folder=str(tmp_path)) == {"FINISHED"}
    image = image_of("Torus Atlas Colour")
    assert image.source == "TILED" and [tile.number for tile in image.tiles] == [1001, 1002]
    assert {path.name for path in tmp_path.iterdir()} == {f"Torus_Atlas_Colour.{tile}.png" for tile in (1001, 1002)}
    for number, obj in enumerate((first, second)):
        uv = uv_maps.read_map(obj.data, uv_maps.bake_map(obj.data))
        assert ((uv > (number, 0)) & (uv < (number + 1, 1))).all()
        baked = bpy.data.images.load(str(tmp_path / f"Torus_Atlas_Colour.{1001 + number}.png"))
        points = Points(obj)
        points.in_middles(baked.size[0])
        wanted = sampled(pixels(image_of("Picture")), points.tiling)
        assert np.abs(sampled(pixels(baked), points.bake - (number, 0), False) - wanted).max() < 2 * STEP


@pytest.mark.parametrize("apart", [False, True])
def test_objects_of_like_names_have_files_of_their_own(tmp_path, apart):
    """Also of names that become one when they are cut, and where one is baked after the other."""
    names = ["Part/1", "Part_1", "part 1", "P" * 60, "P" * 61]
    found = [tiled(torus(name), texture="BRICKS") for name in names]
    for objects in [[obj] for obj in found] if apart else [found]:
        select(*objects)
        assert run(folder=str(tmp_path)) == {"FINISHED"}
    assert len({path.name.casefold() for path in tmp_path.iterdir()}) == len(names)
    baked = [obj.material_slots[0].material.node_tree.nodes["Colour"].image for obj in found]
    assert len({image.filepath_raw for image in baked}) == len(names)


def test_packed_udim_tiles():
    scene()
    assert run(images="UDIM") == {"FINISHED"}
    assert [tile.packed_file.size > 0 for tile in image_of("Torus Atlas Colour").packed_files] == [True, True]


def test_texels_follow_the_units_of_the_scene():
    tiled(torus(), texture="BRICKS")
    run()
    side = image_of("Torus Colour").size[0]
    bpy.context.scene.unit_settings.scale_length = 0.01
    assert run(texels=4000.0) == {"FINISHED"}
    assert image_of("Torus Colour").size[0] == pytest.approx(side, rel=0.1)  # 5.2 packs differently at rounding


def test_the_usual_side(monkeypatch):
    monkeypatch.setattr(module("baking.atlas"), "USUAL_SIDE", 96)
    tiled(torus(), texture="BRICKS")
    assert run(texels=0.0, margin=3) == {"FINISHED"}
    assert tuple(image_of("Torus Colour").size) == (96, 96)
    labels, number = islands(grown(covering(bpy.data.objects["Torus"], 96) > 0, 1))
    assert number > 1
    for label in range(1, number + 1):
        assert not (grown(labels == label, 5) & (labels != label) & (labels > 0)).any()


def no_tiling():
    obj = torus()
    obj.data.materials.append(own_material())
    bpy.ops.uv.holomorphic_maps(main="BALANCED", checker=False)


def no_material():
    tiled(torus())


def no_colour():
    obj = tiled(torus(), texture="BRICKS")
    tree = obj.data.materials[0].node_tree
    tree.links.new(tree.nodes.new("ShaderNodeAddShader").outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])


def no_surface():
    obj = torus()
    obj.data.materials.append(own_material())
    obj.data.materials[0].node_tree.nodes.clear()
    tiled(obj)


def no_slot():
    obj = tiled(torus(), texture="BRICKS")
    for number in range(7):
        obj.data.uv_layers.new(name=f"Own {number}")


def good():
    tiled(torus(), texture="BRICKS")


REFUSALS = [
    (no_tiling, {}, "Torus: it has no seamless tiling"),
    (no_material, {}, "Torus: it has no material"),
    (no_colour, {}, "Torus: its material 'Holomorphic Bricks .turned.. ends in Add Shader"),
    (no_surface, {}, "Torus: its material 'Own' has no surface"),
    (no_slot, {}, "Torus: no UV map slot is free"),
    (good, {"texels": 0.01}, "Torus: 0.01 texels per metre make an image of 1 texel: at least 16 are possible"),
    (good, {"texels": 1e6}, "Torus: 1e.06 texels per metre make an image of .* at most 16,384 are possible"),
    (good, {"margin": 10_000}, "Torus: margins of 10000 texels leave no room for islands"),
    (good, {"channels": set()}, "choose a channel"),
    (good, {"folder": "/no/such/folder"}, "the folder /no/such/folder does not exist"),
]


@pytest.mark.parametrize(("make", "options", "sentence"), REFUSALS)
def test_refusals_leave_everything_as_it_is(make, options, sentence):
    make()
    before = left()
    with pytest.raises(RuntimeError, match=sentence) as raised:
        run(**options)
    assert "Traceback" not in str(raised.value)
    assert not differences(before, left())


def test_a_bake_that_fails_leaves_everything_as_it_is(monkeypatch):
    scene()
    before, baked = left(), module("baking.bake_scene").BakeScene.bake

    def fails(room, copy, map_name, channel, *arguments):
        if channel == "ROUGHNESS":
            raise RuntimeError("Error: out of memory")
        baked(room, copy, map_name, channel, *arguments)

    monkeypatch.setattr(module("baking.bake_scene").BakeScene, "bake", fails)
    with pytest.raises(RuntimeError, match="out of memory"):
        run(channels={"COLOUR", "ROUGHNESS"})
    assert not differences(before, left())


@pytest.mark.parametrize("passes", [1, 2, 4])
def test_a_bake_that_is_cancelled_leaves_everything_as_it_is(passes):
    found = scene()
    before, said = left(), []
    options = bake.BakeOptions(texels=20.0)
    work = bake.BakeWork(bpy.context, found, options, lambda fraction: said.append((fraction, work.watch.stage)))
    work.start()
    for _ in range(passes):
        assert work.is_running()
    work.cancel()
    assert not work.is_running() and not work.baked
    assert len(said) == passes and sorted(said) == said and said[0] == (0.0, "unfolding Torus")
    assert not differences(before, left())


def test_only_in_object_mode():
    tiled(torus(), texture="BRICKS")
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Switch to Object Mode"):
        run()


def test_the_command_bakes(tmp_path):
    torus("Ring")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "in.blend"))
    (tmp_path / "images").mkdir()
    report = tmp_path / "report.json"
    pressed = ("--press", "tile", *sets("texture=BRICKS"), "--press", "bake")
    wanted = sets(f"folder={tmp_path / 'images'}", "texels=30")
    pressed_here(*pressed, *wanted, "--report", report, blend=tmp_path / "in.blend")
    names = {f"Ring_{channel}.png" for channel in ("Colour", "Roughness", "Normal")}
    assert {path.name for path in (tmp_path / "images").iterdir()} == names
    (entry,) = json.loads(report.read_text())["objects"]
    assert entry["baked"]["texels_per_metre"] == pytest.approx(30, rel=0.05)


def test_the_command_refuses_in_one_sentence(tmp_path):
    torus("Ring")
    blend = tmp_path / "in.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    assert "an image of 1 texel" in refusal(
        "--press", "tile", "--press", "bake", *sets("texels=0.01"), blend=blend, status=1
    )
