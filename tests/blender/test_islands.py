"""Islands: seams as cuts, each part flattened with a free boundary, packed by Blender without overlap."""

import bmesh
import bpy
import numpy as np
import pytest
from packed import FLOAT32, assert_packed, capped_cylinder, whole_surface
from scenes import everything, mesh_io, mesh_object, native, run, select, stored_report, torus_arrays, uv

MARGIN = 0.02


def islands(obj, **options):
    return run(main="ISLANDS", **options)


def striped_torus():
    """Quads, cut into three bent strips around its axis, and these open."""
    around, across = 24, 12
    obj = mesh_object("Rings", *torus_arrays(around, across))
    row, column = np.divmod(np.array([e.vertices for e in obj.data.edges]), across)
    is_seam = (row == 0).all(axis=1) | ((column[:, 0] == column[:, 1]) & (column[:, 0] % 4 == 0))
    obj.data.edges.foreach_set("use_seam", is_seam)
    return obj


def shuffle_vertices(obj):
    """Numbers them anew but for the first two, the centres of a cylinder's caps."""
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    for vertex, index in zip(bm.verts[2:], np.random.default_rng(0).permutation(len(bm.verts) - 2).tolist()):
        vertex.index = 2 + index
    bm.verts.sort()
    bm.to_mesh(obj.data)
    bm.free()


def cut_parts(obj):
    """The parts of its surface between the seams."""
    native.load()
    mesh, surface = native.holomorph.mesh, whole_surface(obj)
    seams, count = mesh_io.marked_edges(obj.data, "use_seam"), len(surface.vertices)
    keys, cut = (mesh.edges.edge_keys(ends, count) for ends in (surface._native.edges, seams))
    return mesh.surgery.cut_open(surface, np.isin(keys, cut)).components


def similarities(obj):
    """(#islands,) complex factors by which each island of the library's map was packed, brought to the area that it has
    in space; nothing but a rotation, a factor and a translation was done."""
    factors = []
    for part in cut_parts(obj):
        uv_of_part = native.load().free_boundary_map(part).uv()
        own = uv_of_part @ [1, 1j] * (part.area / native.load().frame(part, uv_of_part).area) ** 0.5
        packed = uv(obj)[part.corner_index] @ [1, 1j]
        own, packed = own - own.mean(), packed - packed.mean()
        factor = np.vdot(own, packed) / np.vdot(own, own)
        assert np.abs(packed - factor * own).max() < FLOAT32
        factors.append(factor)
    return np.array(factors)


def test_a_capped_cylinder_is_flattened_without_distortion():
    obj = capped_cylinder()
    assert islands(obj) == {"FINISHED"}
    entry = stored_report(obj)
    (found,) = [part["main_map"] for part in entry["components"]]
    assert found["mean_angle"] == pytest.approx(1, abs=1e-4) and "into 3 pieces" in found["why"]
    assert found["size_range"] == pytest.approx(1, abs=1e-4)
    assert [m["name"] for m in entry["maps"]] == ["Holomorphic"]
    assert_packed(obj)


def test_islands_are_turned_and_keep_one_texel_density():
    obj = striped_torus()
    assert islands(obj, evenness=0) == {"FINISHED"}
    assert_packed(obj)
    factors = similarities(obj)
    assert len(factors) == 3
    assert np.ptp(np.abs(factors)) < 0.05 * np.abs(factors[0])  # their medians agree, not their boundaries
    assert np.abs(np.angle(factors)).max() > 0.1
    values = uv(obj)
    assert np.ptp(values, axis=0).max() > 1 - 4 * MARGIN  # they fill the square


def test_the_density_dial_is_followed():
    obj = striped_torus()
    assert islands(obj) == {"FINISHED"}
    full = np.ptp(uv(obj), axis=0)
    assert islands(obj, density=0.5) == {"FINISHED"}
    assert np.ptp(uv(obj), axis=0) == pytest.approx(full / 2, rel=1e-3)


def test_several_objects_have_one_texel_density():
    first, second = capped_cylinder(), capped_cylinder()
    second.scale = 3, 3, 3
    select(first, second)
    assert islands(first) == {"FINISHED"}
    small, large = np.abs(similarities(first)), np.abs(similarities(second))
    assert large == pytest.approx(3 * small, rel=1e-4)  # both by their meshes' own lengths
    assert_packed(second)


def test_a_closed_mesh_without_seams_says_what_to_do():
    bpy.ops.mesh.primitive_cube_add()
    obj = bpy.context.object
    before = everything(obj)
    with pytest.raises(RuntimeError, match="no seams cut it open: mark some"):
        islands(obj)
    assert everything(obj) == before


def test_what_no_seam_cuts_open_gets_another_map_and_is_named():
    obj, (vertices, faces) = capped_cylinder(), torus_arrays()
    ring = mesh_object("Ring", vertices + (5, 0, 0), faces)
    select(obj, ring)
    bpy.ops.object.join()
    assert islands(obj) == {"FINISHED"}
    entries = stored_report(obj)["components"]
    told = [entry for entry in entries if "not_followed" in entry]
    assert len(entries) == 2
    assert [entry["genus"] for entry in told] == [1]
    assert "no seams cut it open" in told[0]["not_followed"]


@pytest.mark.parametrize("genus", [0, 1])
def test_an_island_with_several_loops_or_handles_is_cut_open(genus):
    """The side of a cylinder without a seam along it, which is developable; a torus with a seam around one face. The
    parts have numbers of their own for the vertices of the mesh."""
    obj = capped_cylinder(fans=True) if genus == 0 else mesh_object("Ring", *torus_arrays())
    shuffle_vertices(obj)
    if genus == 0:
        sides = [{k for face in obj.data.polygons if len(face.vertices) == n for k in face.edge_keys} for n in (3, 4)]
        rims = sides[0] & sides[1]
    else:
        rims = set(obj.data.polygons[0].edge_keys)
    for edge in obj.data.edges:
        edge.use_seam = edge.key in rims
    assert islands(obj, evenness=0) == {"FINISHED"}
    (entry,) = stored_report(obj)["components"]
    assert "not_followed" not in entry and f"into {3 if genus == 0 else 2} pieces" in entry["main_map"]["why"]
    assert entry["main_map"]["mean_angle"] < (1 + 1e-4 if genus == 0 else 1.2)
    if genus == 0:
        assert_packed(obj)


def test_poles_and_islands_exclude_each_other():
    obj = capped_cylinder()
    obj.data.vertices[0].select = True
    with pytest.raises(RuntimeError, match="neither poles nor corners: choose another main map"):
        islands(obj, use_selection="POLES")


def test_selection_mode_and_scene_are_as_before():
    obj, other = striped_torus(), capped_cylinder()
    select(obj)
    settings = bpy.context.scene.tool_settings
    settings.use_uv_select_sync = False
    objects, meshes = set(bpy.data.objects), set(bpy.data.meshes)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    assert islands(obj) == {"FINISHED"}
    assert obj.mode == "EDIT"
    assert bpy.context.view_layer.objects.active == obj
    assert list(bpy.context.view_layer.objects.selected) == [obj]
    assert not settings.use_uv_select_sync
    assert (set(bpy.data.objects), set(bpy.data.meshes)) == (objects, meshes)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert_packed(obj)
    assert not other.data.uv_layers
