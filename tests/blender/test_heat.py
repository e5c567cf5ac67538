"""Heat maps: the distortion of any UV map, as face attributes and as what is drawn of it."""

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import frame, mesh_io, mesh_object, native, run, select, torus, uv

heat, scales = module("results.heat"), module("overlays.heat_view")


def heat_maps():
    return bpy.ops.uv.holomorphic_heat()


def values(obj, name):
    return mesh_io.read_values(mesh_io.Values(obj.data.attributes[name].data, "value", np.float32))


def grid(count=4, stretch=(1.0, 1.0)):
    """A unit square of quads with the UVs of its positions, stretched."""
    i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
    vertices = np.stack([i / count, j / count, 0 * i], -1).reshape(-1, 3)
    a = (i * (count + 1) + j)[:-1, :-1].ravel()
    faces = np.stack([a, a + count + 1, a + count + 2, a + 1], -1)
    obj = mesh_object("Grid", vertices, faces)
    put_map(obj, vertices[faces.ravel(), :2] * stretch)
    return obj


def put_map(obj, at):
    layer = obj.data.uv_layers.new(name="Artist")
    mesh_io.write_values(module("compatibility").uv_values(layer), at)


@pytest.mark.parametrize("stretch", [(1, 1), (3, 1), (1, 0.2), (-2, 5)])
def test_a_stretched_square(stretch):
    obj = grid(stretch=stretch)
    assert heat_maps() == {"FINISHED"}
    assert np.allclose(values(obj, heat.ANGLE), max(np.abs(stretch)) / min(np.abs(stretch)), rtol=1e-5)
    assert np.allclose(values(obj, heat.DENSITY), 0, atol=1e-5)


def test_size_and_place_of_mesh_and_map_do_not_matter():
    obj = torus()
    run()
    heat_maps()
    before = values(obj, heat.DENSITY), values(obj, heat.ANGLE)
    obj.scale, obj.location, obj.rotation_euler = (1e3,) * 3, (5, 6, 7), (1, 2, 3)
    bpy.context.view_layer.update()
    mesh_io.write_values(module("compatibility").uv_values(obj.data.uv_layers.active), 1e-2 * uv(obj) + 3)
    heat_maps()
    assert np.allclose(values(obj, heat.DENSITY), before[0], atol=1e-2)
    assert np.allclose(values(obj, heat.ANGLE), before[1], atol=1e-2)


def test_the_objects_scale_counts():
    obj = grid()
    obj.scale = (2, 1, 1)
    bpy.context.view_layer.update()
    heat_maps()
    assert np.allclose(values(obj, heat.ANGLE), 2, rtol=1e-5)


@pytest.mark.parametrize("degrees", [0, 30, 90, 180])
def test_the_direction_is_that_to_the_vertical(degrees):
    """On a wall; a floor has none."""
    obj = grid()
    obj.rotation_euler = (np.pi / 2, np.radians(degrees), 0)
    bpy.context.view_layer.update()
    heat_maps()
    assert np.allclose(values(obj, heat.DIRECTION), degrees, atol=1e-3)
    obj.rotation_euler = (0, 0, np.radians(degrees))
    bpy.context.view_layer.update()
    heat_maps()
    assert not values(obj, heat.DIRECTION).any()


def test_where_it_cannot_be_it_says_why():
    torus()
    with pytest.raises(RuntimeError, match="Select a mesh with a UV map"):
        heat_maps()


def test_only_faces_with_a_map_are_measured_and_edit_mode_is_kept():
    first, second = grid(), torus("Bare")
    select(first, second)
    bpy.ops.object.mode_set(mode="EDIT")
    assert heat_maps() == {"FINISHED"}
    assert first.mode == second.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert heat.DENSITY in first.data.attributes and heat.DENSITY not in second.data.attributes


def test_attributes_follow_the_next_run_and_no_run_makes_them():
    obj = torus()
    run()
    assert heat.DENSITY not in obj.data.attributes
    heat_maps()
    run(shown=1)
    shown = values(obj, heat.DENSITY)
    heat_maps()
    assert np.array_equal(values(obj, heat.DENSITY), shown)


def test_an_attribute_of_that_name_is_replaced():
    obj = grid()
    obj.data.attributes.new(heat.ANGLE, "INT", "POINT")
    heat_maps()
    attribute = obj.data.attributes[heat.ANGLE]
    assert (attribute.domain, attribute.data_type) == ("FACE", "FLOAT")
    assert len([a for a in obj.data.attributes if a.name.startswith(heat.ANGLE)]) == 1


def test_scales_begin_and_end_with_their_colours():
    for scale in (scales.DENSITY, scales.ANGLE, scales.DIRECTION):
        places = np.array([-1, 0, 1, 2])
        assert np.allclose(scale.colours(places), [scale.stops[0]] * 2 + [scale.stops[-1]] * 2)
    assert np.allclose(scales.density_places(np.array([-4.0, 0, 4])), [0, 0.5, 1])
    for place, text in scales.ANGLE.ticks:
        assert scales.angle_places(float(text)) == pytest.approx(place, abs=1e-3)


def test_what_is_drawn_is_lit_and_coloured_by_face():
    obj = frame()
    run()
    polygons, found = heat.measured(obj.data, np.eye(3))
    view = module("overlays.heat_view")
    points, colours = view.lit_triangles(polygons, *view.places_and_scale(found, "DENSITY"))
    assert len(points) == len(colours) == 3 * len(native.load().distortion.fans(polygons.face_offsets)[1])
    assert points.dtype == colours.dtype == np.float32
    assert np.isfinite(points).all() and colours.min() >= 0 and colours.max() <= 1
    assert np.array_equal(colours[::3], colours[1::3]) and np.array_equal(colours[::3], colours[2::3])


def test_nothing_is_drawn_in_background_mode(addon):
    overlay = module("overlays.overlay")
    assert bpy.app.background and not overlay._handles
    assert overlay._forget_after_update not in bpy.app.handlers.depsgraph_update_post
    assert bpy.context.window_manager.holomorphic_heat == "NONE"
    addon.unregister()
    assert not hasattr(bpy.types.WindowManager, overlay.HEAT) and not hasattr(bpy.types, "UV_OT_holomorphic_heat")
    addon.register()
    assert hasattr(bpy.types.WindowManager, overlay.HEAT)
