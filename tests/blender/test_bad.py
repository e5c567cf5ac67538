"""A button selects the elements at which a mesh is cut, left out, or badly mapped."""

import bpy
import numpy as np
from loaded_addon import module
from picked_faces import pick_faces
from scenes import grid_arrays, mesh_io, mesh_object, moebius, run, select, torus, torus_arrays, two_parts

Values = module("compatibility").Values


def press(*kinds):
    return bpy.ops.mesh.holomorphic_select_bad(**({"kinds": set(kinds)} if kinds else {}))


def selected(obj):
    """(vertices, edges as pairs, faces) after leaving edit mode."""
    bpy.ops.object.mode_set(mode="OBJECT")
    mesh = obj.data
    flags = [mesh_io.read_values(Values(of, "select", bool)) for of in (mesh.vertices, mesh.edges, mesh.polygons)]
    edges = {tuple(sorted(mesh.edges[int(e)].vertices)) for e in np.flatnonzero(flags[1])}
    return np.flatnonzero(flags[0]).tolist(), edges, np.flatnonzero(flags[2]).tolist()


def fin():
    vertices, faces = torus_arrays()
    edge = int(faces[0][0]), int(faces[0][1])
    return mesh_object("Fin", [*vertices, (0, 0, 2)], [*map(tuple, faces), (*edge, len(vertices))]), edge


def test_an_edge_of_three_faces():
    obj, edge = fin()
    assert run() == {"FINISHED"}
    assert press() == {"FINISHED"}
    assert obj.mode == "EDIT" and tuple(bpy.context.scene.tool_settings.mesh_select_mode) == (False, True, False)
    assert selected(obj) == (sorted(edge), {tuple(sorted(edge))}, [])


def test_where_a_one_sided_part_is_cut_and_nothing_of_the_sound_one():
    strip = moebius().data
    part = ([tuple(v.co) for v in strip.vertices], [tuple(p.vertices) for p in strip.polygons])
    obj = two_parts("Both", torus_arrays(), part)
    run()
    assert press() == {"FINISHED"}
    assert tuple(bpy.context.scene.tool_settings.mesh_select_mode) == (False, True, False)
    vertices, edges, faces = selected(obj)
    assert len(edges) == 1 and not faces and min(vertices) >= len(torus_arrays()[0])


def test_faces_that_stand_twice():
    vertices, faces = torus_arrays()
    obj = mesh_object("Double", vertices, [*faces, faces[5], faces[7][::-1]])
    assert press() == {"FINISHED"}
    assert selected(obj)[2] == [288, 289]


def test_faces_without_area():
    vertices, faces = grid_arrays()
    vertices[8] = vertices[9] = vertices[15]
    obj = mesh_object("Grid", vertices, faces)
    assert press() == {"FINISHED"}
    chosen = selected(obj)[2]
    assert chosen == module("results.bad").find(*read(obj), {"NO_AREA"}).faces.tolist() and chosen


def read(obj):
    (target,) = module("scene.targets").collect([obj])
    return target.polygons, None


def test_vertices_where_faces_touch_and_loose_ones_on_demand():
    vertices, faces = grid_arrays()
    obj = mesh_object("Grid", [*vertices, (0, 0, 9)], faces[[0, 1, 8, 9]])
    assert press() == {"CANCELLED"} and obj.mode == "OBJECT"
    assert press("TOUCHING") == {"FINISHED"}
    assert tuple(bpy.context.scene.tool_settings.mesh_select_mode) == (True, False, False)
    assert selected(obj)[0] == [9]
    press("LOOSE")
    assert 49 in selected(obj)[0] and 9 not in selected(obj)[0]


def test_flipped_uvs_of_any_map():
    obj = mesh_object("Grid", *grid_arrays())
    layer = obj.data.uv_layers.new(name="Own")
    corners = mesh_io.read_indices(module("compatibility").polygon_values(obj.data)[1])
    values = np.array(grid_arrays()[0])[corners, :2]
    turned = slice(4 * 7, 4 * 8)
    values[turned] = values[turned][:, ::-1]
    mesh_io.write_values(module("compatibility").uv_values(layer), values)
    assert press("FLIPPED") == {"FINISHED"}
    assert selected(obj)[2] == [7]


def test_what_is_no_number():
    vertices, faces = torus_arrays()
    vertices[7, 1] = np.nan
    obj = mesh_object("Bad", vertices, faces)
    assert press() == {"FINISHED"}
    assert selected(obj)[0] == [7]


def test_several_objects_of_which_one_is_bad():
    good = torus("Good")
    obj, edge = fin()
    select(good, obj)
    assert press() == {"FINISHED"}
    assert (good.mode, obj.mode) == ("OBJECT", "EDIT") and bpy.context.view_layer.objects.active == obj
    assert selected(obj)[1] == {tuple(sorted(edge))}


def test_in_edit_mode_and_hidden_elements_too():
    obj, edge = fin()
    pick_faces(obj, [40, 41], hidden=[0])
    assert press() == {"FINISHED"} and obj.mode == "EDIT"
    assert selected(obj) == (sorted(edge), {tuple(sorted(edge))}, [])


def test_nothing_bad_changes_nothing():
    obj = torus()
    pick_faces(obj, [40, 41])
    assert press() == {"CANCELLED"} and obj.mode == "EDIT"
    assert selected(obj)[2] == [40, 41]


def test_a_mesh_without_faces():
    obj = mesh_object("Points", [(0, 0, 0), (1, 0, 0)], [])
    assert press() == {"CANCELLED"}
    assert press("LOOSE") == {"FINISHED"} and selected(obj)[0] == [0, 1]
