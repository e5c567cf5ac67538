"""A button repairs meshes: it welds, and removes what stands twice, inside or loose; the rest keeps all its data."""

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import grid_arrays, mesh_io, mesh_object, run, select, torus, torus_arrays

repair = module("results.repair")


def press(**options):
    return bpy.ops.mesh.holomorphic_repair(**options)


def sizes(obj):
    return len(obj.data.vertices), len(obj.data.edges), len(obj.data.polygons)


def spoiled(name="Spoiled"):
    """A torus with a face twice, another one turned over, a loose vertex and a loose edge."""
    vertices, faces = torus_arrays()
    faces = [tuple(map(int, face)) for face in faces]
    obj = mesh_object(name, [*vertices, (0, 0, 9), (0, 0, 7), (0, 0, 8)], [*faces, faces[5], faces[7][::-1]])
    obj.data.edges.add(1)
    obj.data.edges[-1].vertices = len(vertices) + 1, len(vertices) + 2
    obj.data.update()
    return obj


def two_cubes():
    """A box of two cubes with the wall between them."""
    corners = [(x, y, z) for x in range(3) for y in range(2) for z in range(2)]
    at = {corner: index for index, corner in enumerate(corners)}
    walls = [[(x, 0, 0), (x, 1, 0), (x, 1, 1), (x, 0, 1)] for x in range(3)]
    for x in range(2):
        for side in range(2):
            walls.append([(x, side, 0), (x + 1, side, 0), (x + 1, side, 1), (x, side, 1)])
            walls.append([(x, 0, side), (x + 1, 0, side), (x + 1, 1, side), (x, 1, side)])
    return mesh_object("Cubes", corners, [[at[corner] for corner in wall] for wall in walls])


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_several_objects_become_what_they_were_made_of(mode):
    sound = torus("Sound")
    expected = sizes(sound)
    spoiled_ones = [spoiled(name) for name in ("One", "Two")]
    select(*spoiled_ones)
    bpy.ops.object.mode_set(mode=mode)
    assert press() == {"FINISHED"}
    assert {obj.mode for obj in spoiled_ones} == {mode}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert [sizes(obj) for obj in spoiled_ones] == [expected, expected]
    select(*spoiled_ones)
    assert press() == {"CANCELLED"}


def test_counts_are_those_of_what_is_gone():
    done = repair.repair(spoiled().data, {"DOUBLES", "LOOSE"}, 0)
    assert done == repair.Repaired(doubles=2, loose_vertices=3)
    assert str(done) == "removed 2 duplicate faces, removed 3 loose vertices"


def test_an_inside_face_is_removed_and_no_other():
    obj = two_cubes()
    assert repair.repair(obj.data, {"INSIDE"}, 0) == repair.Repaired(inside=1)
    assert sizes(obj) == (12, 20, 10)


def test_welding_takes_the_distance_and_leaves_what_is_farther():
    vertices, faces = grid_arrays()
    apart = np.concatenate([vertices, vertices + [0, 0, 0.01]])
    both = [*map(tuple, faces), *map(tuple, faces + len(vertices))]
    obj = mesh_object("Twice", apart, both)
    assert press(kinds={"WELD"}, distance=0.001) == {"CANCELLED"}
    assert press(distance=0.02) == {"FINISHED"}
    assert sizes(obj)[0] == len(vertices) and sizes(obj)[2] == len(faces)


def with_slivers(count=3):
    """A torus with slivers beside faces, each on an edge from one of its ends on; and one of these on another one."""
    vertices, faces = torus_arrays()
    points, faces = [*vertices], [tuple(map(int, face)) for face in faces]
    for k in range(0, 20 * count, 20):
        a, b, *rest = faces[k]
        points += [0.5 * points[a] + 0.5 * points[b], 0.25 * points[a] + 0.75 * points[b]]
        m, n = len(points) - 2, len(points) - 1
        faces[k] = (a, m, n, b, *rest)
        faces += [(a, b, m), (m, b, n)]
    return mesh_object("Slivers", points, faces)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_slivers_are_merged_with_the_faces_at_their_longest_sides(mode):
    obj = with_slivers(count=3)
    vertices, _, faces = sizes(obj)
    obj.data.uv_layers.new(name="Own")
    points = mesh_io.read_values(module("compatibility").position_values(obj.data))
    bpy.ops.object.mode_set(mode=mode)
    assert press() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert sizes(obj)[::2] == (vertices, faces - 6)
    assert np.array_equal(mesh_io.read_values(module("compatibility").position_values(obj.data)), points)
    surface = mesh_io.read_polygons(obj.data, np.eye(3)).surface()
    assert (surface.genus, surface.boundary_count, len(surface.repairs.zero_area_faces)) == (1, 0, 0)
    assert press() == {"CANCELLED"}


def test_what_slivers_are_merged_with_keeps_its_data():
    obj = with_slivers(count=1)
    mesh = obj.data
    for name in ("First", "Second"):
        mesh.materials.append(bpy.data.materials.new(name))
    for polygon in list(mesh.polygons)[-2:]:
        polygon.material_index = 1
    done = repair.repair(mesh, {"SLIVERS"}, 0)
    assert done == repair.Repaired(slivers=2) and str(done) == "merged 2 slivers"
    assert {polygon.material_index for polygon in mesh.polygons} == {0}


def test_thin_faces_that_have_an_area_stay():
    obj = mesh_object("Thin", [(0, 0, 0), (1, 0, 0), (1, 1e-3, 0), (0, 1e-3, 0)], [(0, 1, 2, 3)])
    assert repair.repair(obj.data, {"SLIVERS"}, 0) == repair.Repaired()


def test_what_stays_keeps_its_data():
    obj = spoiled()
    run()
    mesh = obj.data
    mesh.attributes.new("Own", "FLOAT", "FACE").data[40].value = 7
    mesh.materials.append(bpy.data.materials.new("Second"))
    mesh.polygons[41].material_index = len(mesh.materials) - 1
    obj.shape_key_add(name="Basis")
    obj.shape_key_add(name="Key").data[3].co.z = 5
    corners = len(torus_arrays()[1]) * 4
    maps = {layer.name: uv(layer)[:corners] for layer in mesh.uv_layers}
    assert maps and press() == {"FINISHED"}
    assert {layer.name for layer in mesh.uv_layers} == set(maps)
    for layer in mesh.uv_layers:
        assert np.array_equal(uv(layer), maps[layer.name])
    assert mesh.attributes["Own"].data[40].value == 7
    assert mesh.polygons[41].material_index == len(mesh.materials) - 1
    assert mesh.shape_keys.key_blocks["Key"].data[3].co.z == 5
    assert list(bpy.data.shape_keys) == [mesh.shape_keys]  # the key of a removed copy points to nothing


def uv(layer):
    return mesh_io.read_values(module("compatibility").uv_values(layer))


def test_what_is_no_number_and_what_has_no_faces_stays():
    vertices, faces = torus_arrays()
    vertices[7, 1] = np.nan
    bad, points = mesh_object("Bad", vertices, faces), mesh_object("Points", [(0, 0, 0), (1, 0, 0)], [])
    select(bad, points)
    assert press() == {"CANCELLED"}
    assert len(points.data.vertices) == 2 and len(bad.data.vertices) == len(vertices)
