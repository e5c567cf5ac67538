"""Geometry on a tiling: a piece on each place, where the surface is now; the pieces themselves."""

import math

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import grid_arrays, mesh_io, mesh_object, select, sphere_arrays, tiled, torus, torus_arrays, tube_arrays

names = ("cut", "geometry", "pieces", "placing", "tree")
cut, geometry, pieces, placing, tree = (module(f"things.{name}") for name in names)
compatibility, image_io = module("compatibility"), module("scene.image_io")

SINGLE = 1e-5  # what the single precision of Blender's positions leaves


def put(obj, **options):
    """The object of points."""
    select(obj)
    assert bpy.ops.object.holomorphic_geometry(**options) == {"FINISHED"}
    return bpy.data.objects[f"{obj.name} Geometry"]


def instances(made):
    """(n, 4, 4) in the world."""
    bpy.context.view_layer.update()
    shown = bpy.context.evaluated_depsgraph_get().object_instances
    own = [np.array(i.matrix_world) for i in shown if i.is_instance and i.parent.original == made]
    return np.array(own).reshape(-1, 4, 4)


def places(made):
    return mesh_io.world_points(made)


def set_dials(made, **values):
    compatibility.set_node_inputs(made.modifiers[0], {name.replace("_", " "): v for name, v in values.items()})
    made.update_tag()
    bpy.context.view_layer.update()


def attribute(made, name):
    data = made.data.attributes[name].data
    return np.array([tuple(d.vector) if hasattr(d, "vector") else d.value for d in data])


@pytest.mark.parametrize("piece", sorted(pieces.PIECES))
def test_there_is_a_piece_at_every_place(piece):
    made = put(tiled(torus()), piece=piece, columns=2)
    found = instances(made)
    assert len(found) == len(made.data.vertices) > 20
    height = pieces.PIECES[piece].above
    sizes = np.linalg.norm(found[:, :3, 2], axis=1)
    distances = np.linalg.norm(found[:, :3, 3] - places(made), axis=1)
    assert np.allclose(distances, height * sizes, atol=1e-4)
    assert (np.linalg.det(found[:, :3, :3]) > 0).all()


@pytest.mark.parametrize("lattice", ["square", "brick", "hex"])
@pytest.mark.parametrize("piece", ["STUD", "BRICK"])  # straight, and shifted
def test_the_number_of_places_is_that_of_the_cells(lattice, piece):
    """On a torus without poles: its area in tiles, times the cells in each."""
    made = put(tiled(torus(), lattice=lattice), columns=3, rows=4, piece=piece)
    polygons, uv, name, _ = geometry.source(bpy.data.objects["Torus"])
    starts, following = polygons.face_offsets[:-1], np.arange(len(uv)) + 1
    following[polygons.face_offsets[1:] - 1] = starts
    area = np.sum(uv[:, 0] * uv[following, 1] - uv[following, 0] * uv[:, 1]) / 2
    tile = math.sqrt(0.75) if lattice == "hex" else 1.0
    assert name == lattice
    assert len(made.data.vertices) == round(12 * area / tile)


def test_pieces_stand_along_rows_and_upright():
    made = put(tiled(torus()), columns=3)
    frames = instances(made)[:, :3, :3]
    frames /= np.linalg.norm(frames, axis=1, keepdims=True)
    corners = np.stack([attribute(made, name) for name in tree.VERTICES], axis=1)
    positions = mesh_io.world_points(bpy.data.objects["Torus"])[corners]
    edges = positions[:, 1:] - positions[:, :1]
    flat = np.cross(edges[:, 0], edges[:, 1])
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    row = np.einsum("ni,nix->nx", attribute(made, placing.ROW_STEP)[:, :2], edges)
    row /= np.linalg.norm(row, axis=1, keepdims=True)
    assert np.einsum("ij,ij->i", frames[:, :, 2], flat).min() > 0.9
    assert np.einsum("ij,ij->i", frames[:, :, 0], row).min() > 0.9


def deformed(obj):
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return mesh_io.read_values(compatibility.position_values(shown.data)) @ np.array(obj.matrix_world)[:3, :3].T


def on_deformed(made, obj):
    """(n, 3) where the places are now."""
    corners = np.stack([attribute(made, name) for name in tree.VERTICES], axis=1)
    shown = np.einsum("ni,nix->nx", attribute(made, tree.BARYCENTRIC), deformed(obj)[corners])
    return shown + np.array(obj.matrix_world)[:3, 3]


def bent_by_armature(obj):
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.scene.collection.objects.link(rig)
    select(rig)
    bpy.ops.object.mode_set(mode="EDIT")
    for name, low, high in (("Lower", 0.0, 1.5), ("Upper", 1.5, 4.0)):
        bone = rig.data.edit_bones.new(name)
        bone.head, bone.tail = (0, 0, low), (0, 0, high)
    bpy.ops.object.mode_set(mode="OBJECT")
    for vertex in obj.data.vertices:
        share = min(max(vertex.co.z / 3, 0), 1)
        for name, weight in (("Lower", 1 - share), ("Upper", share)):
            group = obj.vertex_groups.get(name) or obj.vertex_groups.new(name=name)
            group.add([vertex.index], weight, "REPLACE")
    obj.modifiers.new("Armature", "ARMATURE").object = rig
    rig.pose.bones["Upper"].rotation_mode = "XYZ"
    rig.pose.bones["Upper"].rotation_euler = (0.8, 0, 0.3)


def moved_by_key(obj):
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Key")
    for point in key.data:
        point.co = (1.5 * point.co.x, point.co.y, point.co.z + 0.3 * point.co.x)
    key.value = 1.0


@pytest.mark.parametrize("bend", [bent_by_armature, moved_by_key])
def test_pieces_follow_the_surface(bend):
    obj = tiled(mesh_object("Tube", *tube_arrays()))
    made = put(obj, piece="RIVET", columns=3)
    before = instances(made)[:, :3, 3]
    bend(obj)
    after = instances(made)[:, :3, 3]
    assert np.linalg.norm(after - before, axis=1).max() > 0.2
    assert np.allclose(after, on_deformed(made, obj), atol=SINGLE * 10)


def test_pieces_follow_the_object():
    obj = torus()
    obj.location, obj.rotation_euler, obj.scale = (3, 2, 1), (0.4, 0.5, 0.6), (1, 2, 1)
    bpy.context.view_layer.update()
    made = put(tiled(obj), piece="RIVET")
    assert np.allclose(instances(made)[:, :3, 3], places(made), atol=SINGLE * 10)
    obj.location = (0, 0, 0)
    assert np.allclose(instances(made)[:, :3, 3] + (3, 2, 1), places(made), atol=SINGLE * 10)


def test_pieces_are_outside_of_a_mirrored_object():
    obj = torus()
    obj.scale = (-1, 1, 1)
    bpy.context.view_layer.update()
    made = put(tiled(obj), piece="RIVET", columns=2)
    found = instances(made)
    centres = found[:, :3, 3] * (1, 1, 0)
    centres /= np.linalg.norm(centres, axis=1, keepdims=True)
    assert np.einsum("ij,ij->i", found[:, :3, 2], found[:, :3, 3] - centres).min() > 0


def linking_numbers(matrices, curves):
    """How often a closed curve goes up through the disk of the ring of each matrix, less how often down."""
    inside = np.linalg.inv(matrices)
    local = np.einsum("nab,nkb->nka", inside[:, :3, :3], curves) + inside[:, None, :3, 3]
    following = np.roll(local, -1, axis=1)
    height, rise = local[:, :, 2], following[:, :, 2] - local[:, :, 2]
    is_through = (height < 0) != (following[:, :, 2] < 0)
    part = np.where(is_through, -height / np.where(is_through, rise, 1), 0)
    radius = np.linalg.norm((local + part[:, :, None] * (following - local))[:, :, :2], axis=2)
    return np.sum(np.sign(rise) * (is_through & (radius < pieces.RADIUS)), axis=1)


def circles(matrices, count=64):
    angle = 2 * np.pi * np.arange(count) / count
    flat = pieces.RADIUS * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    return np.einsum("nab,kb->nka", matrices[:, :3, :3], flat) + matrices[:, None, :3, 3]


def test_mail_is_linked_four_in_one():
    """On a torus that is not flat: every ring holds two of each of the rows beside its own, and no others."""
    made = put(tiled(torus(around=48, across=24)), piece="RING", columns=6)
    matrices = instances(made)
    curves, size = circles(matrices), np.linalg.norm(matrices[:, :3, 0], axis=1)
    apart = np.linalg.norm(matrices[:, None, :3, 3] - matrices[None, :, :3, 3], axis=2)
    first, second = np.nonzero(np.triu(apart < np.maximum(size[:, None], size), 1))
    numbers = linking_numbers(matrices[first], curves[second])
    assert np.array_equal(np.abs(numbers), np.abs(linking_numbers(matrices[second], curves[first])))
    is_linked = numbers != 0
    counts = np.bincount(np.concatenate([first[is_linked], second[is_linked]]), minlength=len(curves))
    assert (counts == 4).all()


def test_rings_of_flat_mail_do_not_touch():
    ring = pieces.PIECES["RING"]
    matrices = []
    for row in range(-2, 3):
        for column in range(-2, 3):
            angle = ring.tilt * (1 - 2 * (row % 2))
            turn = [[1, 0, 0], [0, math.cos(angle), math.sin(angle)], [0, -math.sin(angle), math.cos(angle)]]
            place = [[column + row % 2 / 2], [row * ring.height], [0]]
            matrices.append(np.vstack([np.hstack([turn, place]), [0, 0, 0, 1]]))
    curves = circles(np.array(matrices))
    middle = curves[12]
    others = np.delete(curves, 12, axis=0)
    assert np.linalg.norm(middle[:, None, None] - others, axis=3).min() > 2 * pieces.WIRE


def test_stitches_go_on_and_do_not_touch():
    cell = pieces.Cell(pieces.PIECES["STITCH"].height)
    yarn = pieces.stitch(cell)
    assert np.allclose(yarn[-1] - yarn[0], (1, 0, 0))
    row = np.concatenate([yarn + (k, 0, 0) for k in (-1, 0, 1)])
    for number in (1, 2):
        above = row + (0, number * cell.height, 0)
        assert np.linalg.norm(yarn[:, None] - above, axis=2).min() > 2 * pieces.YARN


@pytest.mark.parametrize("piece", sorted(pieces.PIECES))
@pytest.mark.parametrize("cell", [(0.5, 0.5), (0.5, 0.0), (math.sqrt(0.75), 0.5), (1.0, 0.0)])
def test_pieces_are_small_and_face_outwards(piece, cell):
    vertices, faces = pieces.PIECES[piece].formula(pieces.Cell(*cell))
    assert np.isfinite(vertices).all() and len(faces) < 400
    triangles = np.array([(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)])
    a, b, c = np.moveaxis(vertices[triangles], 1, 0)
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() > 0
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    assert len(np.unique(sides, axis=0)) == len(sides)
    if piece != "STITCH":  # whose yarn goes on in the next cell
        assert {*map(tuple, sides.tolist())} == {*map(tuple, sides[:, ::-1].tolist())}


def test_dials():
    obj = tiled(torus())
    made = put(obj, piece="BRICK", columns=2)
    everything = instances(made)
    set_dials(made, Size=2.0)
    assert np.allclose(instances(made)[:, :3, :3], 2 * everything[:, :3, :3], atol=1e-4)
    set_dials(made, Size=1.0, Height=0.5)
    assert np.linalg.norm(instances(made)[:, :3, 3] - everything[:, :3, 3], axis=1).min() > 1e-3
    set_dials(made, Height=0.0, Random_Size=0.5, Random_Tilt=0.3, Seed=4)
    one = instances(made)
    set_dials(made, Seed=5)
    assert not np.allclose(one, instances(made), atol=1e-3)
    set_dials(made, Seed=4)
    assert np.array_equal(one, instances(made))
    set_dials(made, Random_Size=0.0, Random_Tilt=0.0, Least_Size=100.0)
    assert not len(instances(made))


def test_the_mask_is_a_vertex_group():
    obj = tiled(torus())
    made = put(obj, piece="STUD", columns=2)
    group = obj.vertex_groups.new(name="Here")
    group.add([v.index for v in obj.data.vertices if v.co.x > 0], 1.0, "REPLACE")
    set_dials(made, Vertex_Group="Here")
    found = instances(made)
    assert 0 < len(found) < len(made.data.vertices)
    assert found[:, 0, 3].min() > -0.3


def picture(values):
    """An image of (h, w) greys, not interpolated where they are alike."""
    values = np.asarray(values, float)
    made = bpy.data.images.new("Picture", values.shape[1], values.shape[0], float_buffer=True)
    made.colorspace_settings.name = "Non-Color"
    image_io.write_pixels(made, np.dstack([values] * 3 + [np.ones_like(values)]))
    made.pack()
    return made


def shares(made):
    """(n, 2) of a UV unit: where the places lie in it."""
    polygons, uv, *_ = geometry.source(bpy.data.objects["Torus"])
    corners = np.stack([attribute(made, name) for name in tree.CORNERS], axis=1)
    return np.einsum("ni,nix->nx", attribute(made, tree.BARYCENTRIC), uv[corners]) % 1


def nearest(points, found):
    """(k,) the point that each of the found ones is."""
    return np.linalg.norm(points[None] - found[:, None], axis=2).argmin(axis=1)


@pytest.mark.parametrize("of_another", [False, True])
def test_the_mask_is_an_image(of_another):
    """On the tiling itself, in which it repeats, or on a map of the artist's."""
    obj = torus()
    if of_another:
        layer = obj.data.uv_layers.new(name="Painted")
        values = np.array([obj.data.vertices[loop.vertex_index].co.x > 0.3 for loop in obj.data.loops], float)
        layer.data.foreach_set("uv", np.stack([0.2 + 0.6 * values, 0 * values + 0.5], axis=1).ravel())
    made = put(tiled(obj), piece="RIVET", columns=4)
    black_and_white = picture(np.repeat([[0.0, 1.0]], 16, axis=1).repeat(4, axis=0))
    named = {"UV Map of Image": "Painted"} if of_another else {}
    compatibility.set_node_inputs(made.modifiers[0], {"Image": black_and_white, "Image Masks": True} | named)
    made.update_tag()
    found = instances(made)
    is_shown = np.isin(np.arange(len(places(made))), nearest(places(made), found[:, :3, 3]))
    assert 0 < len(found) < len(is_shown)
    if of_another:
        side = places(made)[:, 0]
        assert is_shown[side > 0.8].all() and not is_shown[side < -0.1].any()
    else:
        along = shares(made)[:, 0]
        clear = np.abs((along % 0.5) - 0.25) < 0.2
        assert np.array_equal(is_shown[clear], along[clear] > 0.5)


def test_an_image_chooses_from_a_collection():
    """Black the first of them, white the last."""
    obj = tiled(torus())
    collection_of(block("A"), block("B"), block("C"))
    made = put(obj, piece="COLLECTION", source="Pieces", columns=3)
    greys = picture(np.repeat([[0.0, 0.5, 1.0]], 16, axis=1).repeat(4, axis=0))
    set_dials(made, Image=greys, Image_Chooses=True)
    shown = bpy.context.evaluated_depsgraph_get().object_instances
    placed = [(i.object.name, np.array(i.matrix_world), i.parent.original) for i in shown if i.is_instance]
    names, points = zip(*[(name, matrix[:3, 3]) for name, matrix, parent in placed if parent == made])
    third = (3 * shares(made)[nearest(places(made), np.array(points))][:, 0]) % 3
    clear = np.abs(third % 1 - 0.5) < 0.4
    assert np.array_equal(np.array(names)[clear], np.array(["A", "B", "C"])[third[clear].astype(int)])


def test_without_an_image_nothing_is_masked():
    made = put(tiled(torus()), piece="STUD", columns=2)
    assert len(instances(made)) == len(made.data.vertices)


def test_pieces_shrink_at_poles():
    obj = mesh_object("Ball", *sphere_arrays(3))
    bpy.ops.uv.holomorphic_tile(tiles=12, checker=False)
    made = put(obj, piece="RIVET", columns=6)
    set_dials(made, Least_Size=0.0, Around_Poles=0.0)
    everything = len(instances(made))
    assert everything == len(made.data.vertices)
    set_dials(made, Around_Poles=2.0)
    near = (attribute(made, placing.POLE_DISTANCE) < 1.0).sum()
    assert everything - len(instances(made)) >= near > 0


def block(name):
    return mesh_object(name, *sphere_arrays(0))


def collection_of(*objects):
    made = bpy.data.collections.new("Pieces")
    for obj in objects:
        made.objects.link(obj)
    return made


@pytest.mark.parametrize("by_chance", [True, False])
def test_a_collection(by_chance):
    obj = tiled(torus())
    collection_of(block("One"), block("Two"))
    made = put(obj, piece="COLLECTION", source="Pieces", columns=2)
    set_dials(made, By_Chance=by_chance)
    shown = bpy.context.evaluated_depsgraph_get().object_instances
    names = [i.object.name for i in shown if i.is_instance and i.parent.original == made]
    assert len(names) == len(made.data.vertices) and set(names) == {"One", "Two"}


def test_an_object_of_ones_own():
    obj = tiled(torus())
    block("Own")
    made = put(obj, piece="OBJECT", source="Own", columns=2)
    assert len(instances(made)) == len(made.data.vertices)
    assert "Own" in bpy.data.objects and len(bpy.data.objects) == 3


def test_several_parts():
    first, second = torus_arrays(), torus_arrays(12, 8)
    vertices = [*first[0], *(np.asarray(second[0]) + (0, 0, 3))]
    faces = [tuple(f) for f in first[1]] + [tuple(i + len(first[0]) for i in f) for f in second[1]]
    made = put(tiled(mesh_object("Both", vertices, faces)), piece="RIVET", columns=2)
    heights = instances(made)[:, 2, 3]
    assert (heights > 2).any() and (heights < 1).any() and len(heights) == len(made.data.vertices)


def test_a_second_run_replaces_the_first_and_keeps_copies():
    obj = tiled(torus())
    put(obj, piece="BRICK")
    copy = bpy.data.objects["Torus Geometry"].copy()
    bpy.context.scene.collection.objects.link(copy)
    put(obj, piece="RIVET")
    names = sorted(o.name for o in bpy.data.objects)
    assert names == ["Torus", "Torus Brick", "Torus Geometry", "Torus Geometry.001", "Torus Rivet"]
    bpy.data.objects.remove(copy)
    put(obj, piece="STUD")
    assert sorted(o.name for o in bpy.data.objects) == ["Torus", "Torus Geometry", "Torus Stud"]
    assert len([g for g in bpy.data.node_groups if tree.MADE_BY in g]) == 1


def test_undo_leaves_nothing():
    obj = tiled(torus())
    bpy.ops.ed.undo_push(message="before")
    before = sorted(o.name for o in bpy.data.objects), len(bpy.data.meshes), len(bpy.data.node_groups)
    put(obj)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert (sorted(o.name for o in bpy.data.objects), len(bpy.data.meshes), len(bpy.data.node_groups)) == before


def refused(sentence, **options):
    count = len(bpy.data.objects), len(bpy.data.meshes), len(bpy.data.node_groups)
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.object.holomorphic_geometry(**options)
    assert (len(bpy.data.objects), len(bpy.data.meshes), len(bpy.data.node_groups)) == count


def test_a_map_that_is_no_tiling_is_refused():
    torus()
    bpy.ops.uv.holomorphic_maps(main="BALANCED")
    refused("not a seamless tiling: press Seamless Tiling")
    for other in (bpy.ops.object.holomorphic_lines, bpy.ops.object.holomorphic_cells):
        with pytest.raises(RuntimeError, match="not a seamless tiling: press Seamless Tiling"):
            other()


def test_no_map_is_refused():
    torus()
    refused("no UV map: press Seamless Tiling")


def test_no_faces_are_refused():
    mesh_object("Points", [(0, 0, 0), (1, 0, 0)], [])
    refused("has no faces")


def test_places_that_are_too_few_are_refused():
    obj = mesh_object("Sheet", *grid_arrays(2))
    obj.data.uv_layers.new(name="UVMap")
    uv = np.full((len(obj.data.loops), 2), 0.1, np.float32)
    uv += 0.01 * mesh_io.world_points(obj)[[loop.vertex_index for loop in obj.data.loops]][:, :2]
    mesh_io.write_values(compatibility.uv_values(obj.data.uv_layers[0]), uv)
    refused("no place lies on it", columns=1, rows=1)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (dict(piece="OBJECT"), "choose the object"),
        (dict(piece="COLLECTION", source="Missing"), "choose the collection"),
        (dict(piece="COLLECTION", source="Pieces"), "collection Pieces is empty"),
        (dict(piece="OBJECT", source="Torus"), "cannot be put on itself"),
    ],
)
def test_pieces_that_are_none_are_refused(options, sentence):
    tiled(torus())
    collection_of()
    refused(sentence, **options)


def evaluated(made):
    """(vertices in the world, number of faces) of what its modifier makes."""
    bpy.context.view_layer.update()
    shown = made.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return mesh_io.read_values(compatibility.position_values(shown.data)), len(shown.data.polygons)


def test_lines_have_the_material_of_the_surface_and_another_by_their_dial():
    own, other = (bpy.data.materials.new(name) for name in ("Own", "Other"))
    obj = tiled(torus())
    obj.data.materials.append(own)
    assert bpy.ops.object.holomorphic_lines() == {"FINISHED"}
    made = bpy.data.objects["Torus Lines"]
    for material in (own, other):
        if material == other:
            set_dials(made, Material=other)
        bpy.context.view_layer.update()
        shown = made.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        used = {shown.materials[face.material_index].original for face in shown.polygons}
        assert used == {material}


@pytest.mark.parametrize(("direction", "least"), [("U", 2), ("V", 2), ("BOTH", 4)])
def test_lines_are_wires_on_the_surface(direction, least):
    tiled(torus())
    assert bpy.ops.object.holomorphic_lines(direction=direction, per_tile=1) == {"FINISHED"}
    made = bpy.data.objects["Torus Lines"]
    assert len(made.data.edges) == len(made.data.vertices) > least  # every line of a torus is closed
    set_dials(made, Radius=0.02, Sides=6)
    vertices, faces = evaluated(made)
    assert len(vertices) == faces == 6 * len(made.data.vertices)
    middles = vertices.reshape(-1, 6, 3).mean(axis=1)
    order = np.lexsort(np.round(places(made), 3).T)
    assert np.allclose(middles[np.lexsort(np.round(middles, 3).T)], places(made)[order], atol=5e-3)
    assert np.allclose(np.linalg.norm(vertices.reshape(-1, 6, 3) - middles[:, None], axis=2), 0.02, rtol=0.3)


def test_lines_follow_the_surface():
    obj = tiled(mesh_object("Tube", *tube_arrays()))
    bpy.ops.object.holomorphic_lines()
    made = bpy.data.objects["Tube Lines"]
    set_dials(made, Radius=1e-4)
    moved_by_key(obj)
    made.update_tag()
    vertices, _ = evaluated(made)
    assert np.allclose(vertices.max(axis=0), on_deformed(made, obj).max(axis=0), atol=1e-3)


@pytest.mark.parametrize("simple", [False, True])
@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1)])
def test_cells_of_a_torus(simple, scale):
    """Quads alone, on a mesh of the same topology, corners at whole numbers."""
    obj = torus()
    obj.scale = scale
    bpy.context.view_layer.update()
    tiled(obj, tiles=100)
    assert bpy.ops.object.holomorphic_cells(columns=1, rows=1, simple=simple) == {"FINISHED"}
    made = bpy.data.objects["Torus Cells"]
    mesh = made.data
    assert len(mesh.vertices) - len(mesh.edges) + len(mesh.polygons) == 0
    assert all(entry.value for entry in mesh.attributes["is_quad"].data)
    uv = mesh_io.read_values(compatibility.uv_values(mesh.uv_layers["Holomorphic"]))
    assert np.abs(uv - np.rint(uv)).min(axis=1).max() < SINGLE
    centres, normals = (np.array([getattr(p, name) for p in mesh.polygons]) for name in ("center", "normal"))
    middles = centres * (1, 1, 0) / np.linalg.norm(centres[:, :2], axis=1, keepdims=True)
    assert np.einsum("ij,ij->i", normals, centres - middles).min() > 0
    if simple:
        assert {polygon.loop_total for polygon in mesh.polygons} == {4}


def test_bricks_of_a_torus():
    """Two and two in each tile, every other row shifted: three edges at each vertex."""
    tiled(torus(), tiles=100)
    assert bpy.ops.object.holomorphic_cells(columns=1, rows=1, simple=True) == {"FINISHED"}
    count = len(bpy.data.objects["Torus Cells"].data.polygons)
    assert bpy.ops.object.holomorphic_cells(columns=2, rows=2, shifted=True, simple=True) == {"FINISHED"}
    mesh = bpy.data.objects["Torus Cells"].data
    assert len(mesh.polygons) == 4 * count
    assert len(mesh.edges) * 2 == len(mesh.vertices) * 3
    with pytest.raises(RuntimeError, match="an even number"):
        bpy.ops.object.holomorphic_cells(rows=3, shifted=True)


def test_irregular_vertices_are_counted():
    """A cube has eight corners of three edges, a sheet has none."""
    offsets = np.arange(0, 25, 4)
    cube = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    made = cut.CutMesh(np.zeros((8, 3)), np.ravel(cube), offsets, np.zeros((24, 2)), {}, np.ones(24, bool))
    assert made.irregular == 8 and made.mirrored().irregular == 8
    vertices, faces = grid_arrays(3)
    corners = np.ravel(faces)
    ends = np.arange(0, len(corners) + 1, 4)
    sheet = cut.CutMesh(vertices, corners, ends, np.zeros((0, 2)), {}, np.zeros(len(corners), bool))
    assert sheet.irregular == 0
