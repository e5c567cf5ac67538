"""A mesh of quads over the active object, with what it has."""

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import grid_arrays, mesh_io, mesh_object, select, torus, tube_arrays

quads, compatibility = module("things.quads"), module("compatibility")
SINGLE = 1e-5  # what the single precision of Blender's positions leaves
BENT = 0.02  # of the whole: Blender interpolates over quads, which are triangles here


def make(obj, **options):
    select(obj)
    assert bpy.ops.object.holomorphic_quads(**options) == {"FINISHED"}
    return bpy.data.objects[f"{obj.name} Quads"]


def read(elements, name, dtype=np.float32, width=1):
    return mesh_io.read_values(compatibility.Values(elements, name, dtype, width))


def positions(obj):
    return read(obj.data.vertices, "co", np.float32, 3)


@pytest.mark.parametrize("scale", [(1, 1, 1), (-2, 1, 1)])
def test_a_torus_has_quads_alone_that_look_out(scale):
    obj = torus()
    obj.scale, obj.location = scale, (3, 0, 0)
    bpy.context.view_layer.update()
    before = positions(obj).copy()
    made = make(obj, faces=400)
    mesh = made.data
    assert {polygon.loop_total for polygon in mesh.polygons} == {4}
    assert abs(len(mesh.polygons) - 400) < 40
    assert len(mesh.vertices) - len(mesh.edges) + len(mesh.polygons) == 0
    assert made.matrix_world == obj.matrix_world and (positions(obj) == before).all()
    uv = mesh_io.read_values(compatibility.uv_values(mesh.uv_layers[quads.MAP]))
    assert np.abs(uv - np.rint(uv)).max() < SINGLE
    centres, normals = (np.array([getattr(p, name) for p in mesh.polygons]) for name in ("center", "normal"))
    middles = centres * (1, 1, 0) / np.linalg.norm(centres[:, :2], axis=1, keepdims=True)
    assert np.einsum("ij,ij->i", normals, centres - middles).min() > 0


def test_weights_maps_materials_and_modifiers_are_those_of_the_mesh():
    obj = mesh_object("Sheet", *grid_arrays(9))
    x = positions(obj)[:, 0]
    middle = 5  # between two columns
    group = obj.vertex_groups.new(name="Bend")
    for vertex, own in enumerate(x):
        group.add([vertex], float((own - x.min()) / np.ptp(x)), "REPLACE")
    for name in ("Left", "Right"):
        obj.data.materials.append(bpy.data.materials.new(name))
    for polygon in obj.data.polygons:
        polygon.material_index = int(polygon.center.x > middle)
    layer = obj.data.uv_layers.new(name="Own")
    for loop, place in zip(obj.data.loops, layer.data):
        place.uv = obj.data.vertices[loop.vertex_index].co[:2]
    obj.modifiers.new("Bend", "SIMPLE_DEFORM")
    made = make(obj, faces=200)
    own = positions(made)
    weights = np.array([vertex.groups[0].weight for vertex in made.data.vertices])
    assert np.allclose(weights, (own[:, 0] - x.min()) / np.ptp(x), atol=BENT)
    assert [modifier.name for modifier in made.modifiers] == ["Bend"]
    assert [material.name for material in made.data.materials] == ["Left", "Right"]
    is_right = read(made.data.polygons, "material_index", np.int32) == 1
    centre = np.array([polygon.center.x for polygon in made.data.polygons])
    side = np.sqrt(np.ptp(x) * np.ptp(positions(obj)[:, 1]) / 200)
    assert (is_right == (centre > middle))[np.abs(centre - middle) > side].all()
    corners = read(made.data.loops, "vertex_index", np.int32)
    uv = mesh_io.read_values(compatibility.uv_values(made.data.uv_layers["Own"]))
    assert np.allclose(uv, own[corners, :2], atol=9 * BENT)


def test_another_run_replaces_the_first_and_keeps_the_cones():
    obj = torus()
    make(obj, faces=300)
    (kept,) = quads.KEPT.values()
    made = make(obj, faces=600)
    assert list(quads.KEPT.values()) == [kept]
    assert sum(other.name.startswith("Torus Quads") for other in bpy.data.objects) == 1
    assert abs(len(made.data.polygons) - 600) < 60


def test_two_halves_are_alike():
    obj = torus(bulge=0)
    longer = positions(obj) * np.array([1.5, 1, 1], np.float32)  # else it has planes all around
    mesh_io.write_values(compatibility.Values(obj.data.vertices, "co", np.float32, 3), longer)
    own = positions(make(obj, faces=300, mirror=True))

    def off(mirrored):
        return np.linalg.norm(own[:, None] - mirrored, axis=2).min(axis=1).max()

    assert min(off(own * (-1, 1, 1)), off(own * (1, -1, 1))) < SINGLE


def test_hard_edges_are_edges():
    """The rims of a tube with borders: their vertices lie on them."""
    made = make(mesh_object("Tube", *tube_arrays()), faces=300)
    assert {polygon.loop_total for polygon in made.data.polygons} == {4}


@pytest.mark.parametrize(
    ("options", "message"),
    [({"faces": 8}, "take more faces"), ({"mirror": True}, "does not mirror itself")],
)
def test_what_cannot_be_is_refused_in_a_sentence(options, message):
    obj = torus()
    own = positions(obj) + 0.05 * np.random.default_rng(0).random((len(obj.data.vertices), 3), np.float32)
    mesh_io.write_values(compatibility.Values(obj.data.vertices, "co", np.float32, 3), own)
    select(obj)
    count = len(bpy.data.objects)
    with pytest.raises(RuntimeError, match=message):
        bpy.ops.object.holomorphic_quads(**options)
    assert len(bpy.data.objects) == count and len(bpy.data.meshes) == count
