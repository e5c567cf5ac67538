"""Textures: their images, and the materials that show them."""

import functools

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import (
    run,
    torus,
    uv_maps,
)

own, patterns, textures = (module(f"materials.{name}") for name in ("user_texture", "patterns", "textures"))
SIZE = 512  # pixels of a drawing here
LINES = {  # columns and rows of cells, whose borders are alike
    "NUMBERED": (8, 8),
    "BRICKS": (8, 8),
    "SCALES": (8, 8),
    "WEAVE": (16, 16),
    "PLANKS": (1, 8),
    "HEXAGONS": (14, 8),
}


@pytest.fixture(params=patterns.TEXTURES)
def texture(request):
    return request.param


@functools.cache
def drawn_once(texture):
    return patterns.TEXTURES[texture].draw(SIZE)


def pixels(image):
    values = np.empty(4 * image.size[0] * image.size[1], np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], 4)[..., :3].astype(np.float64)


def nodes(obj):
    return obj.material_slots[0].material.node_tree.nodes


def shown_image(obj):
    """What reaches the base colour."""
    shader = next(n for n in nodes(obj) if n.type == "BSDF_PRINCIPLED")
    return shader.inputs["Base Color"].links[0].from_node.image


def layers(pattern):
    return pattern.colour if pattern.height is None else np.dstack([pattern.colour, pattern.height])


def test_the_properties_name_every_texture():
    names = [name for name, *_ in module("operators.properties").TEXTURES]
    assert names == [module("materials.material").CHECKER, *patterns.TEXTURES, own.IMAGE, own.MATERIAL]


def test_values_are_colours_and_heights(texture):
    drawn = layers(drawn_once(texture))
    assert drawn.shape[:2] == (SIZE, SIZE) and drawn.min() >= 0 and drawn.max() <= 1.05


def test_every_drawing_is_the_same(texture):
    assert np.array_equal(layers(drawn_once(texture)), layers(patterns.TEXTURES[texture].draw(SIZE)))


@pytest.mark.parametrize(("axis", "lines"), [(0, 1), (1, 0)])
def test_the_border_is_no_edge(texture, axis, lines):
    """Across it, pixels differ no more than across lines inside that lie in the same way between the cells."""
    drawn = layers(drawn_once(texture))
    step = np.abs(np.roll(drawn, -1, axis) - drawn).mean(axis=(1 - axis, 2))
    count = LINES[texture][lines]
    inside = (np.arange(1, count) * SIZE / count).astype(int) - 1 if count > 1 else np.arange(SIZE - 1)
    assert step[-1] <= 1.3 * step[inside].max() + 1e-12


def test_no_two_numbered_tiles_are_alike_however_they_lie():
    side = SIZE // patterns.CELLS
    drawn = drawn_once("NUMBERED").colour.reshape(patterns.CELLS, side, patterns.CELLS, side, 3)
    tiles = drawn.transpose(0, 2, 1, 3, 4).reshape(-1, side, side, 3)
    turned = np.stack([np.rot90(t, k, (1, 2)) for t in (tiles, tiles[:, :, ::-1]) for k in range(4)]).reshape(8, 64, -1)
    difference = np.array([[np.abs(turned[k] - tile.ravel()).mean(axis=1) for k in range(8)] for tile in tiles])
    own = difference[np.arange(64), 0, np.arange(64)].copy()
    assert np.all(own == 0)
    difference[np.arange(64), 0, np.arange(64)] = np.inf
    assert difference.min() > 0.01


def test_a_tile_says_where_it_lies():
    """B3 is the second from the left and the third from the bottom."""
    side = SIZE // patterns.CELLS
    drawn = drawn_once("NUMBERED").colour
    tile = drawn[2 * side : 3 * side, side : 2 * side]
    sign = patterns._sign("B3", side)
    ground = patterns._tile_colours()[2, 1]
    assert np.allclose(tile[3:-3, 3:-3][sign[3:-3, 3:-3] == 0], ground)
    ink = tile[sign == 1]
    assert len(ink) > 20 and np.allclose(ink, ink[0]) and np.abs(ink[0] - ground).max() > 0.3


def test_material_and_packed_images(texture):
    obj = torus()
    assert run(texture=texture) == {"FINISHED"}
    image = shown_image(obj)
    assert image.packed_file is not None and tuple(image.size) == (patterns.SIZE, patterns.SIZE)
    expected = textures._srgb(patterns.TEXTURES[texture].draw(patterns.SIZE).colour)
    assert np.abs(pixels(image) - expected).max() < 0.51 / 255
    uv = next(n for n in nodes(obj) if n.type == "UVMAP")
    assert uv.uv_map == "Holomorphic"
    assert nodes(obj).active.type == "TEX_IMAGE"
    bpy.ops.uv.holomorphic_restore_materials()
    assert len(obj.material_slots) == 0


def test_the_relief_keeps_heights_that_one_channel_would_step(texture):
    height = patterns.TEXTURES[texture].draw(patterns.SIZE).height
    relief = textures.relief_image(texture)
    assert (relief is None) == (texture == "NUMBERED") == (height is None)
    if relief is not None:
        assert relief.colorspace_settings.name == "Non-Color"
        found = pixels(relief) @ (1, 1 / textures.STEPS, 0)
        assert np.abs(found - np.clip(height, 0, 1)).max() < 1 / 255**2


def test_images_are_made_once_in_a_file(monkeypatch):
    first = torus("First")
    run(texture="BRICKS")
    images = sorted(i.name for i in bpy.data.images)
    monkeypatch.setattr(textures, "_drawn", None)
    second = torus("Second")
    run(texture="BRICKS")
    assert sorted(i.name for i in bpy.data.images) == images
    assert shown_image(first) == shown_image(second)


def test_images_come_back_the_same_in_another_file(monkeypatch):
    obj = torus()
    run(texture="WEAVE")
    before = pixels(shown_image(obj))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    monkeypatch.setattr(textures, "_drawn", None)  # the file of the image is kept
    obj = torus()
    run(texture="WEAVE")
    assert np.array_equal(pixels(shown_image(obj)), before)
    assert shown_image(obj).packed_file is not None


@pytest.mark.parametrize(("cells", "repeats"), [(1, 1), (4, 1), (13, 3), (40, 10), (500, 125)])
def test_a_unit_has_a_whole_number_of_images(cells, repeats):
    obj = torus()
    run(texture="SCALES", checker_scale=cells)
    assert nodes(obj)["Repeats"].outputs[0].default_value == repeats
    preview = nodes(obj)["Preview"].image
    assert nodes(obj).active == nodes(obj)["Preview"]
    shown = min(repeats, textures.MOST_REPEATS)
    width = preview.size[0] // shown
    values = pixels(preview)
    assert width * shown == preview.size[0]
    assert np.array_equal(values, np.tile(values[:width, :width], (shown, shown, 1)))


def test_the_relief_grows_with_the_object():
    obj = torus()
    run(texture="SCALES")
    small = nodes(obj)["Relief"].outputs[0].default_value
    assert 0 < small < 1
    obj.scale = (10, 10, 10)
    bpy.context.view_layer.update()
    run(texture="SCALES")
    assert nodes(obj)["Relief"].outputs[0].default_value == pytest.approx(10 * small, rel=1e-5)
    run(texture="SCALES", density=2.0)
    assert nodes(obj)["Relief"].outputs[0].default_value == pytest.approx(5 * small, rel=1e-5)


def test_a_map_that_is_an_attribute():
    obj = torus()
    for index in range(8):
        obj.data.uv_layers.new(name=f"Artist {index}")
    run(texture="PLANKS")
    assert any(n.type == "ATTRIBUTE" and n.attribute_name == "Holomorphic" for n in nodes(obj))


def test_from_one_texture_to_another_and_back_to_the_artists_material():
    obj = torus()
    mine = bpy.data.materials.new("Mine")
    obj.data.materials.append(mine)
    for texture in ("BRICKS", "CHECKER", "HEXAGONS", "BRICKS"):
        run(texture=texture)
        assert obj.material_slots[0].material.name == f"Holomorphic {texture.title()}"
    bpy.ops.uv.holomorphic_restore_materials()
    assert [(s.link, s.material) for s in obj.material_slots] == [("DATA", mine)]


def test_nodes_that_the_user_has_rebuilt_stay():
    obj = torus()
    run(texture="BRICKS")
    tree = obj.material_slots[0].material.node_tree
    tree.nodes.clear()
    tree.nodes.new("ShaderNodeEmission")
    assert run(texture="BRICKS", checker_scale=16) == {"FINISHED"}
    assert [n.type for n in tree.nodes] == ["EMISSION"]
    assert uv_maps.MAIN_MAP in obj.data.uv_layers


def test_fewer_bricks_than_squares_span_an_object():
    obj = torus()
    material = module("materials.material")
    counts = {}
    for texture in ("CHECKER", "BRICKS"):
        run(main="BALANCED", texture=texture)
        counts[texture] = material.across(texture)
    assert counts["BRICKS"] < counts["CHECKER"]
    bricks = nodes(obj)["Repeats"].outputs[0].default_value * material.cells("BRICKS")
    run(main="BALANCED", texture="WEAVE")
    threads = nodes(obj)["Repeats"].outputs[0].default_value * material.cells("WEAVE")
    assert threads > 2 * bricks
