"""Relief in Blender: a new closed object beside the old one, in millimetres of the scene."""

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import mesh_io, select, tiled, torus

geometry, relief, image_io = (module(name) for name in ("things.geometry", "things.relief", "scene.image_io"))

SIZE = 16
UNITS = [("METRIC", 0.001, 0.05), ("NONE", 0.5, 0.05), ("METRIC", 2.0, 100.0)]  # mm for 5 % of a unit


def picture(name="Dots", size=SIZE):
    """A white square on black, without colours."""
    image = bpy.data.images.new(name, size, size)
    pixels = np.zeros((size, size, 4), np.float32)
    pixels[size // 4 : size // 2, size // 4 : size // 2] = 1
    pixels[:, :, 3] = 1
    image_io.write_pixels(image, pixels)
    return image


def raise_on(obj, **options):
    select(obj)
    given = {"image": "Dots", "most_triangles": 20000} | options
    assert bpy.ops.object.holomorphic_relief(**given) == {"FINISHED"}
    return bpy.data.objects[f"{obj.name} Relief"]


def triangles(made):
    return np.array([polygon.vertices[:] for polygon in made.data.polygons])


def is_closed(made):
    each = triangles(made)
    sides = np.concatenate([each[:, [k, (k + 1) % 3]] for k in range(3)])
    there, back = {*map(tuple, sides.tolist())}, {*map(tuple, sides[:, ::-1].tolist())}
    return len(there) == len(sides) and there == back


def volume(made):
    a, b, c = np.moveaxis(mesh_io.world_points(made)[triangles(made)], 1, 0)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def refused(obj, **options):
    """What the operator says, having changed nothing."""
    select(obj)
    before = {*bpy.data.objects.keys()}, {*bpy.data.meshes.keys()}
    with pytest.raises(RuntimeError) as error:
        bpy.ops.object.holomorphic_relief(**options)
    assert before == ({*bpy.data.objects.keys()}, {*bpy.data.meshes.keys()})
    return str(error.value)


def test_a_new_closed_object_of_the_chosen_depth():
    picture()
    obj = tiled(torus())
    before = mesh_io.world_points(obj)
    made = raise_on(obj, depth=50.0)  # of metres
    assert is_closed(made)
    assert np.array_equal(mesh_io.world_points(obj), before)
    points = mesh_io.world_points(made)
    ring = points * (1, 1, 0)
    ring /= np.linalg.norm(ring, axis=1, keepdims=True)
    own = before * (1, 1, 0)
    own /= np.linalg.norm(own, axis=1, keepdims=True)
    radii = np.linalg.norm(points - ring, axis=1)
    assert radii.max() == pytest.approx(np.linalg.norm(before - own, axis=1).max() + 0.05, abs=0.01)
    assert made.data.uv_layers[0].name == obj.data.uv_layers[0].name


@pytest.mark.parametrize(("system", "scale", "depth"), UNITS)
def test_millimetres_are_those_of_the_scene(system, scale, depth):
    picture()
    obj = tiled(torus())
    in_metres = np.ptp(mesh_io.world_points(raise_on(obj, depth=50.0)), axis=0)
    bpy.context.scene.unit_settings.system = system
    bpy.context.scene.unit_settings.scale_length = scale
    assert np.allclose(np.ptp(mesh_io.world_points(raise_on(obj, depth=depth)), axis=0), in_metres, atol=1e-4)


def test_a_second_run_replaces_the_first():
    picture()
    obj = tiled(torus())
    raise_on(obj)
    count = len(raise_on(obj, level=1.0).data.polygons)
    assert [len(o.data.polygons) for o in bpy.data.objects if o.name.startswith("Torus Relief")] == [count]
    assert len([m for m in bpy.data.meshes if m.name.startswith("Torus Relief")]) == 1


def test_mirrored_and_moved_objects_are_raised_outwards():
    picture()
    obj = torus()
    obj.scale, obj.location = (-1, 1, 1), (3, 2, 1)
    bpy.context.view_layer.update()
    engraved = volume(raise_on(tiled(obj), level=1.0))
    raised = raise_on(obj)
    assert 0 < engraved < volume(raised)
    assert is_closed(raised)
    assert np.allclose(mesh_io.world_points(raised).mean(axis=0), (3, 2, 1), atol=0.1)


def test_materials_are_kept():
    picture()
    obj = tiled(torus())
    for name in ("Red", "Blue"):
        obj.data.materials.append(bpy.data.materials.new(name))
    count = len(obj.data.materials)
    for polygon in obj.data.polygons:
        polygon.material_index = polygon.index % count
    made = raise_on(obj)
    assert [m.name for m in made.data.materials] == [m.name for m in obj.data.materials]
    assert {p.material_index for p in made.data.polygons} == {*range(count)}


def test_the_picture_is_that_of_the_material():
    image = picture()
    obj = tiled(torus())
    material = bpy.data.materials.new("Bumpy")
    module("compatibility").enable_nodes(material)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    texture, bump = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeBump")
    texture.image = image
    links.new(texture.outputs["Color"], bump.inputs["Height"])
    obj.data.materials.clear()
    obj.data.materials.append(material)
    assert relief.shown_heights(material) == (image, 1)
    assert is_closed(raise_on(obj, image=""))


def test_a_texture_of_ours_is_raised_as_often_as_it_is_shown():
    obj = torus()
    shown = dict(poles="COUNT", pole_count=0, checker=True, texture="SCALES")
    assert bpy.ops.uv.holomorphic_tile(tiles=12, **shown) == {"FINISHED"}
    image, repeats = relief.shown_heights(obj.active_material)
    assert image.name == "Holomorph Scales Relief"
    assert relief.channel_weights(image) == relief.TWO_CHANNELS
    nodes = obj.active_material.node_tree.nodes
    nodes["Repeats"].outputs[0].default_value = 2
    twice, once = (raise_on(obj, image="", repeats=count) for count in (0, 1))
    assert repeats >= 1
    assert is_closed(once)
    with pytest.raises(ReferenceError):
        twice.name  # noqa: B018  replaced


def test_what_cannot_be_is_one_sentence():
    picture()
    plain = bpy.data.images.new("Plain", 1, 1)
    obj = torus()
    assert "press Seamless Tiling first" in refused(obj, image="Dots")
    tiled(obj)
    assert "choose the image" in refused(obj, image="None")
    assert "everywhere: nothing can be raised" in refused(obj, image=plain.name)
    assert "more than the size of the whole mesh" in refused(obj, image="Dots", depth=1e6)
    missing = bpy.data.images.new("Missing", 4, 4)
    missing.source, missing.filepath = "FILE", "//none.png"
    assert "it has no pixels" in refused(obj, image="Missing")
    for loop in obj.data.uv_layers.active.data:
        loop.uv *= 0.9
    assert "is not a seamless tiling" in refused(obj, image="Dots")


def test_it_tells_of_crossings_and_of_plain_parts():
    class Found:
        triangles, crossings = np.zeros((9, 3)), np.array([[1, 2], [1, 3]])
        depth, safe_depth, error, is_full = 0.2, 0.1, 0.5, True

    class Work:
        skipped, inside_out, heights = 2, 1, np.eye(4, 8)

    assert relief.sentence(Found, 1000.0, Work) == (
        "9 triangles, 200 mm deep; 2 parts without a tiling stay flat; inside out: 1 closed parts; recalculate their "
        "normals; the picture has 8 x 4 pixels: each tile shows it stretched to a square, by 2; up to 100 mm off: "
        "allow more triangles to follow the picture; it crosses itself in 3 triangles: up to 100 mm deep it does not"
    )


def test_it_is_cancelled():
    picture()
    obj = tiled(torus())
    polygons, uv, lattice, turns = geometry.source(obj)
    pixels = image_io.read_pixels(bpy.data.images["Dots"])
    found = relief.heights_of(pixels, None)
    work = relief.RaisingWork(polygons, uv, lattice, turns, None, lambda fraction: None, heights=found)
    work.cancel()
    work.run()
    assert type(work.error).__name__ == "Cancelled"
