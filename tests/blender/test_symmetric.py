"""Make Symmetric: images and materials of the user's that look the same after the turns of the map that shows them."""

import bpy
import numpy as np
import pytest
from drawn_images import periodic_noise
from loaded_addon import module
from scenes import mesh_object, run, sphere_arrays, stored_report, uv

averages, user_texture, image_io = map(module, ("materials.averages", "materials.user_texture", "scene.image_io"))
SIZE = 64


def ball():
    return mesh_object("Ball", *sphere_arrays(3))


def noise(name="Noise", seed=3, fall=1.5):
    """A picture with colours that differ, and of no symmetry."""
    made = bpy.data.images.new(name, SIZE, SIZE)
    made.colorspace_settings.name = "Non-Color"
    colours = [0.5 + 0.12 * periodic_noise(SIZE, SIZE, fall, seed + k) for k in range(3)]
    image_io.write_pixels(made, np.clip(np.dstack([*colours, np.ones((SIZE, SIZE))]), 0, 1))
    made.pack()
    return made


def tile(**options):
    return bpy.ops.uv.holomorphic_tile(**{"texture": "IMAGE", "source": "Noise", "turns": "QUARTER"} | options)


def make():
    return bpy.ops.uv.holomorphic_make_symmetric()


def groups(obj):
    tree = obj.material_slots[0].material.node_tree
    return [node for node in tree.nodes if node.type == "GROUP" and node.node_tree.name.startswith("Symmetric")]


def shown_pixels(material):
    """(SIZE, SIZE, 3) of what a material shows over the UV square, baked as light of its own."""
    bpy.ops.mesh.primitive_plane_add(size=1)
    plane = bpy.context.object
    plane.data.uv_layers[0].name = "Holomorphic"
    own = material.copy()
    plane.data.materials.append(own)
    tree = own.node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    light = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(shader.inputs["Base Color"].links[0].from_socket, light.inputs["Color"])
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(light.outputs[0], output.inputs["Surface"])
    target = tree.nodes.new("ShaderNodeTexImage")
    target.image = bpy.data.images.new("Baked", SIZE, SIZE, float_buffer=True)
    tree.nodes.active = target
    bpy.context.scene.render.engine = "CYCLES"
    settings = bpy.context.scene.cycles
    settings.samples, settings.use_denoising, settings.use_adaptive_sampling = 1, False, False
    bpy.ops.object.bake(type="EMIT", margin=0)
    return image_io.read_pixels(target.image)[..., :3].astype(np.float64)


def tiled_once(own, turns):
    """The material that shows an `Own` once over the UV square."""
    material = module("materials.material")
    look = material.Look(own.kind, 1, 0.0, True, own.on_turned(turns), True)
    return material.showing("Holomorphic", False, look)


@pytest.mark.parametrize(("name", "turns"), [("HALF", 2), ("QUARTER", 4)])
def test_it_looks_the_same_after_the_turns(name, turns):
    """About the corner of the image, with the colours and the contrast that it had."""
    image = noise()
    plain = user_texture.Own("IMAGE", "Noise", "square")
    before = shown_pixels(tiled_once(plain, 1))
    assert np.abs(before - image_io.read_pixels(image)[..., :3]).max() < 1e-3
    own = user_texture.symmetric(plain, turns)
    assert (own.turns, own.averaged) == (turns, turns)
    after = shown_pixels(tiled_once(own, turns))
    for quarters in range(4 // turns, 4, 4 // turns):
        assert np.abs(np.rot90(after, quarters) - after).max() < 2e-3
    assert np.abs(np.rot90(before, 4 // turns) - before).max() > 0.2
    assert np.allclose(after.mean(axis=(0, 1)), before.mean(axis=(0, 1)), atol=0.1)
    assert np.allclose(after.std(axis=(0, 1)), before.std(axis=(0, 1)), rtol=0.3)
    if turns == 2:
        assert np.abs(np.rot90(after) - after).max() > 0.2


def test_an_image_that_is_symmetric_already_keeps_its_contrast():
    """What is averaged is alike: it loses none."""
    made = bpy.data.images.new("Waves", SIZE, SIZE)
    made.colorspace_settings.name = "Non-Color"
    y, x = (np.indices((SIZE, SIZE)) + 0.5) * 2 * np.pi / SIZE
    grey = 0.5 + 0.15 * np.cos(x) * np.cos(y) + 0.03 * periodic_noise(SIZE, SIZE, 1.0, 4)
    image_io.write_pixels(made, np.dstack([grey, grey, grey, np.ones_like(grey)]))
    own = user_texture.symmetric(user_texture.Own("IMAGE", "Waves", "square"), 2)
    assert 0.7 < own.alike < 0.95
    after = shown_pixels(tiled_once(own, 2))
    assert after.std() == pytest.approx(grey.std(), rel=0.1)


def test_one_click_and_what_is_told():
    obj = ball()
    image = noise()
    tile()
    assert obj.holomorph_map.made.shown_turns == 4
    before, colours = uv(obj), image_io.read_pixels(image)
    assert make() == {"FINISHED"}
    (group,) = groups(obj)
    assert sum(node.type == "TEX_IMAGE" for node in group.node_tree.nodes) == 4
    assert obj.holomorph_map.made.shown_turns == 0
    assert np.array_equal(uv(obj), before) and np.array_equal(image_io.read_pixels(image), colours)
    assert make() == {"CANCELLED"} and len(groups(obj)) == 1


def test_it_stays_when_the_map_is_made_again():
    """As long as the texture is the same; and goes with the maps."""
    obj = ball()
    noise()
    noise("Other")
    tile()
    make()
    tile(tiles=200, turns="FROM_TEXTURE")
    assert len(groups(obj)) == 1 and stored_report(obj)["components"][0]["tiling"]["turns"] == 4
    assert len([one for one in bpy.data.node_groups if one.name.startswith("Symmetric")]) == 1
    tile(turns="NONE")
    assert not groups(obj)
    tile(source="Other")
    assert not groups(obj)
    bpy.ops.uv.holomorphic_remove_maps()
    tile()
    assert not groups(obj)


def test_it_can_be_undone():
    obj = ball()
    noise()
    tile()
    bpy.ops.ed.undo_push(message="before")
    make()
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Ball"]
    assert not groups(obj) and obj.holomorph_map.made.shown_turns == 4


def stone():
    """A material of the user's with a colour and a normal map, in a group of nodes."""
    made = bpy.data.materials.new("Stone")
    made.use_nodes = True
    nodes, link = made.node_tree.nodes, made.node_tree.links.new
    shader = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    for name, socket in (("Noise", "Base Color"), ("Normals", "Normal")):
        picture = nodes.new("ShaderNodeTexImage")
        picture.image = bpy.data.images[name]
        normal = nodes.new("ShaderNodeNormalMap") if socket == "Normal" else None
        if normal:
            link(picture.outputs["Color"], normal.inputs["Color"])
        link((normal or picture).outputs[0], shader.inputs[socket])
    return made


def test_the_images_of_a_material():
    """Its normals are turned with the surface."""
    obj = ball()
    noise()
    noise("Normals", seed=20)
    stone()
    tile(texture="MATERIAL", source="Stone")
    make()
    found = {group.node_tree.name.removeprefix("Symmetric ").split(".")[0]: group for group in groups(obj)}
    assert set(found) == {"Noise", "Normals"}
    count = {name: len(group.node_tree.nodes) for name, group in found.items()}
    assert count["Normals"] > count["Noise"]
    assert found["Normals"].outputs["Color"].links[0].to_node.type == "NORMAL_MAP"
    assert not any(node.type == "GROUP" for node in bpy.data.materials["Stone"].node_tree.nodes)


def test_normals_turn_with_the_surface():
    """f(R x) = R f(x)."""
    noise("Normals", seed=20)
    material = bpy.data.materials.new("Normals Alone")
    material.use_nodes = True
    nodes, link = material.node_tree.nodes, material.node_tree.links.new
    shader = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    picture, where, normal = (nodes.new(f"ShaderNode{kind}") for kind in ("TexImage", "UVMap", "NormalMap"))
    picture.image = bpy.data.images["Normals"]
    link(where.outputs[0], picture.inputs["Vector"])
    link(picture.outputs["Color"], normal.inputs["Color"])
    averages.put(material.node_tree, 4, (0.0, 0.0), 0.0)
    (group,) = (node for node in nodes if node.type == "GROUP")
    link(group.outputs["Color"], shader.inputs["Base Color"])
    x, y = np.moveaxis(shown_pixels(material)[..., :2] - 0.5, -1, 0)
    turned_x, turned_y = x[:, ::-1].T, y[:, ::-1].T  # at R x
    assert np.abs(turned_x + y).max() < 3e-3 and np.abs(turned_y - x).max() < 3e-3 and np.ptp(x) > 0.2


WRONG = {
    "a wide image": (lambda: bpy.data.images.new("Noise", SIZE, SIZE // 2), "QUARTER", "square images"),
    "sixth turns": (noise, "SIXTH", "squares: set Turns to Half or Quarter"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_cannot_be_made_symmetric_is_told(name, capfd):
    image, turns, words = WRONG[name]
    obj = ball()
    image = image()
    pixels = np.random.default_rng(1).random((image.size[1], image.size[0], 4))
    image_io.write_pixels(image, pixels)
    image.pack()
    tile(turns=turns)
    assert make() == {"CANCELLED"} and not groups(obj)
    assert f"Noise: Make Symmetric is for {words}" in capfd.readouterr().out


def test_textures_of_ours_are_left_alone():
    obj = ball()
    tile(texture="SCALES")
    assert obj.holomorph_map.made.shown_turns == 0 and make() == {"CANCELLED"}
    run(main="BALANCED")
    assert make() == {"CANCELLED"}


def test_the_panel_offers_it():
    """Where a texture shows its turns, and no longer when it is averaged."""
    obj = ball()
    noise()
    tile()
    assert obj.holomorph_map.made.shown_turns
    make()
    assert not obj.holomorph_map.made.shown_turns


def test_a_picture_that_became_wide_is_shown_as_it_is():
    obj = ball()
    noise()
    tile()
    make()
    bpy.data.images["Noise"].scale(SIZE, SIZE // 2)
    assert tile() == {"FINISHED"} and not groups(obj)
