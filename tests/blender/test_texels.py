"""Texels per metre: the same on several objects, measured and set."""

from functools import partial

import bpy
import numpy as np
import pytest
from loaded_addon import module
from picked_faces import HALF, add_own_map, corners_of, leave, pick_faces
from scenes import (
    edge_jumps,
    everything,
    face_densities,
    fills_the_square,
    grid_arrays,
    limb_arrays,
    mesh_io,
    mesh_object,
    run,
    select,
    stored_report,
    torus,
    uv,
    uv_maps,
)

LIKE = 1.1  # largest over smallest median density of parts whose squares have one size
NEAR = 1.2  # tiles that turn may miss the size by a fifth where other maps cost more by as much
ROUNDED = 0.1  # relative: a tiling has whole numbers of tiles around, of 100 that are a few each
TURNED = 0.2  # of one that turns, whose cones lie at centres of tiles: a tenth of lengths
MEASURED = 0.03  # relative: the library takes the median over triangles, not quads
FLAT = 1e-3  # relative: quads of the library are two triangles, and float32


def overall(obj):
    """UV length for a length on the surface, in the object's own frame."""
    areas = np.array([p.area for p in obj.data.polygons])
    return np.sqrt((np.abs(face_densities(obj)) * areas).sum() / areas.sum())


def median(obj):
    """UV length for a length on the surface, by area."""
    densities, areas = np.abs(face_densities(obj)), np.array([p.area for p in obj.data.polygons])
    order = np.argsort(densities)
    covered = np.cumsum(areas[order])
    return np.sqrt(densities[order][np.searchsorted(covered, covered[-1] / 2)])


def two_sizes():
    small, large = torus("Small"), torus("Large")
    for vertex in large.data.vertices:
        vertex.co *= 3
    select(small, large)
    return small, large


def flat(name, size, uv_size):
    """A square with its UVs a square."""
    vertices = size * np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    obj = mesh_object(name, vertices, [(0, 1, 2, 3)])
    layer = obj.data.uv_layers.new(name="Own")
    values = 0.25 + uv_size * np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32)
    mesh_io.write_values(module("compatibility").uv_values(layer), values)
    return obj


def texels():
    return bpy.context.window_manager.holomorphic_texels


def test_several_objects_have_one_density_and_the_largest_map_fills_the_square():
    small, large = two_sizes()
    assert run() == {"FINISHED"}
    assert overall(small) == pytest.approx(overall(large), rel=FLAT)
    assert fills_the_square(uv(large)) and fills_the_square(uv(small), density=1 / 3)
    run(equal=False)
    assert fills_the_square(uv(large)) and fills_the_square(uv(small))
    assert overall(small) == pytest.approx(3 * overall(large), rel=FLAT)


def test_the_scale_of_objects_counts():
    first, second = torus("First"), torus("Second")
    second.scale = (2, 2, 2)
    select(first, second)
    run(density=0.5)
    assert overall(first) == pytest.approx(overall(second) / 2, rel=FLAT)


def test_tilings_of_several_objects_have_one_density():
    vertices, faces = limb_arrays()
    first, second = mesh_object("First", vertices, faces), mesh_object("Second", 2 * np.array(vertices), faces)
    select(first, second)
    assert run(main="SEAMLESS") == {"FINISHED"}
    assert all("tiling" in stored_report(obj)["components"][0] for obj in (first, second))
    assert median(second) == pytest.approx(median(first), rel=ROUNDED)
    run(main="SEAMLESS", equal=False)
    assert median(second) < 0.7 * median(first)


def limbs(*scales):
    """Objects of these scales, the first one active."""
    objects = [mesh_object(f"Limb {scale}", *limb_arrays()) for scale in scales]
    for obj, scale in zip(objects, scales):
        obj.scale = (scale, scale, scale)
    select(*objects)
    bpy.context.view_layer.update()
    return objects


def in_space(obj):
    """Tiles for an area in space, the median."""
    return (median(obj) / obj.scale[0]) ** 2


def area_in_space(obj):
    return obj.scale[0] ** 2 * sum(polygon.area for polygon in obj.data.polygons)


@pytest.mark.parametrize("press", [partial(run, main="AUTOMATIC"), bpy.ops.uv.holomorphic_tile], ids=["button", "tile"])
def test_the_default_is_that_of_the_largest_part_whichever_is_active(press):
    (alone,) = limbs(2.0)
    press()
    wanted = in_space(alone)
    objects = limbs(0.8, 2.0, 1.3)
    press()
    found = [in_space(obj) for obj in objects]
    assert found[1] == pytest.approx(wanted, rel=FLAT) and max(found) <= NEAR * min(found)


@pytest.mark.parametrize(("turns", "rounded"), [("NONE", ROUNDED), ("FROM_TEXTURE", TURNED)])
def test_tiles_are_over_all_objects(turns, rounded):
    objects = limbs(1.0, 2.0)
    bpy.ops.uv.holomorphic_tile(tiles=300, turns=turns)
    assert sum(in_space(obj) * area_in_space(obj) for obj in objects) == pytest.approx(300, rel=rounded)
    densities = [in_space(obj) for obj in objects]
    assert max(densities) <= LIKE * min(densities)
    bpy.ops.uv.holomorphic_tile(tiles=300, equal=False, turns=turns)
    assert [in_space(obj) * area_in_space(obj) for obj in objects] == pytest.approx([300, 300], rel=rounded)


def test_poles_are_dragged_at_the_size_that_all_objects_have():
    small, _ = limbs(1.0, 2.0)
    bpy.ops.uv.holomorphic_tile(tiles=300)
    before = median(small)
    assert module("operators.drag_session").Session(small).mapped.tiled[0].map.density == pytest.approx(
        before**2, rel=FLAT
    )


def test_a_plain_map_beside_a_tiling_has_its_density():
    limb, plate = mesh_object("Limb", *limb_arrays()), mesh_object("Grid", *grid_arrays())
    select(limb, plate)
    run(main="AUTOMATIC")
    assert "tiling" in stored_report(limb)["components"][0] and "tiling" not in stored_report(plate)["components"][0]
    assert median(plate) == pytest.approx(median(limb), rel=MEASURED)


def test_the_tile_operator_gives_several_objects_one_density():
    small, large = two_sizes()
    bpy.ops.uv.holomorphic_tile(tiles=300)
    assert median(large) == pytest.approx(median(small), rel=ROUNDED)
    bpy.ops.uv.holomorphic_tile(tiles=300, equal=False)
    assert median(large) == pytest.approx(median(small) / 3, rel=ROUNDED)


def test_get_and_set():
    obj = flat("Square", size=2, uv_size=0.5)
    assert bpy.ops.uv.holomorphic_texels_get(image=1024) == {"FINISHED"}
    assert texels() == pytest.approx(256)
    assert bpy.ops.uv.holomorphic_texels_set(image=1024, texels=128) == {"FINISHED"}
    assert np.allclose(uv(obj, "Own"), 0.5 + 0.125 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]))
    bpy.ops.uv.holomorphic_texels_get(image=2048)
    assert texels() == pytest.approx(256)


def test_scale_and_units_count():
    obj = flat("Square", size=2, uv_size=0.5)
    obj.scale = (0.5, 0.5, 0.5)
    bpy.context.scene.unit_settings.scale_length = 0.01  # a unit is a centimetre
    bpy.context.view_layer.update()
    bpy.ops.uv.holomorphic_texels_get(image=1000)
    assert texels() == pytest.approx(50_000)


def test_set_makes_several_objects_equal_and_leaves_those_without_a_map():
    first, second = flat("First", 1, 0.1), flat("Second", 3, 0.7)
    bare = torus("Bare")
    before = everything(bare)
    select(first, second, bare)
    assert bpy.ops.uv.holomorphic_texels_set(image=100, texels=30) == {"FINISHED"}
    assert np.ptp(uv(first, "Own"), axis=0) == pytest.approx(0.3) and np.ptp(
        uv(second, "Own"), axis=0
    ) == pytest.approx(0.9)
    assert everything(bare) == before
    select(bare)
    assert bpy.ops.uv.holomorphic_texels_set() == {"CANCELLED"}


def test_a_duplicate_keeps_its_map():
    """Meshes share arrays with their copies from Blender 4.0 on: whoever writes one in place changes both."""
    obj = flat("Square", size=2, uv_size=0.5)
    other = bpy.data.objects.new("Duplicate", obj.data.copy())
    before = uv(other, "Own")
    assert bpy.ops.uv.holomorphic_texels_set(texels=7.0) == {"FINISHED"}
    assert np.array_equal(uv(other, "Own"), before) and not np.allclose(uv(obj, "Own"), before)


def test_in_edit_mode_selected_faces_are_scaled():
    obj = torus()
    own = add_own_map(obj)
    pick_faces(obj, HALF)
    assert bpy.ops.uv.holomorphic_texels_set(texels=1) == {"FINISHED"}
    leave()
    chosen = corners_of(HALF)
    rest = np.setdiff1d(np.arange(len(own)), chosen)
    values = uv_maps.read_map(obj.data, "Artist")
    assert np.array_equal(values[rest], own[rest]) and not np.array_equal(values[chosen], own[chosen])


def test_a_tiling_is_scaled_by_whole_numbers():
    obj = torus()
    bpy.ops.uv.holomorphic_tile(tiles=30, turns="NONE")
    before, (_, jumps) = uv(obj), edge_jumps(obj)
    bpy.ops.uv.holomorphic_texels_get(image=1000)
    bpy.ops.uv.holomorphic_texels_set(image=1000, texels=2.8 * texels())
    after = uv(obj)
    assert np.allclose(after, 3 * before, atol=1e-5)
    is_whole = jumps == np.round(jumps)
    assert is_whole.mean() > 0.9 and np.array_equal(edge_jumps(obj)[1][is_whole], 3 * jumps[is_whole])
    bpy.ops.uv.holomorphic_texels_set(image=1000, texels=1)
    assert np.array_equal(uv(obj), after)


def test_a_map_without_area_is_told_of():
    obj = mesh_object("Grid", *grid_arrays())
    obj.data.uv_layers.new(name="Own", do_init=False)
    mesh_io.write_values(module("compatibility").uv_values(obj.data.uv_layers[0]), np.zeros((len(obj.data.loops), 2)))
    assert bpy.ops.uv.holomorphic_texels_get() == {"CANCELLED"}
