"""Meshes for the tests, and what can be read off them."""

import importlib
import json
from functools import partial

import bmesh
import bpy
import numpy as np
from repository import ROOT

uv_maps = importlib.import_module("holomorph_addon.scene.uv_maps")
mesh_io = importlib.import_module("holomorph_addon.scene.mesh_io")
stored = importlib.import_module("holomorph_addon.results.stored")
native = importlib.import_module("holomorph_addon.native")


def open_example(name):
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "blend_examples" / f"{name}.blend"))


def select(*objects):
    """Selects just these, the first one active."""
    bpy.context.view_layer.update()
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj in objects)
    bpy.context.view_layer.objects.active = objects[0]


def pick(obj, vertices):
    """Edit mode with these vertices selected one after the other."""
    if obj.mode == "EDIT":
        bpy.ops.object.mode_set(mode="OBJECT")
    select(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_mode(type="VERT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bm = bmesh.from_edit_mesh(obj.data)
    bm.verts.ensure_lookup_table()
    for index in vertices:
        bm.verts[index].select = True
        bm.select_history.add(bm.verts[index])
    bm.select_flush_mode()
    bmesh.update_edit_mesh(obj.data)


def mesh_object(name, vertices, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(v) for v in vertices], [], [tuple(f) for f in faces])
    mesh.update()
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    select(obj)
    return obj


def tube_arrays(around=32, along=12):
    """An uneven tube: triangles of all shapes, both ends wavy."""
    i, j = np.meshgrid(np.arange(around), np.arange(along), indexing="ij")
    angle, height = 2 * np.pi * i / around + 0.2 * np.sin(j), j / 3 + 0.2 * np.sin(3 * 2 * np.pi * i / around)
    radius = 1 + 0.3 * np.sin(height) + 0.2 * np.cos(2 * angle)
    vertices = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], -1).reshape(-1, 3)
    a = np.arange(around * along).reshape(around, along)
    b = np.roll(a, -1, axis=0)
    return vertices, np.stack([a[:, :-1], b[:, :-1], b[:, 1:], a[:, 1:]], -1).reshape(-1, 4)


def torus_arrays(around=24, across=12, thickness=0.4, bulge=0.3):
    """Quads of a torus, uneven where it bulges."""
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    u, v = 2 * np.pi * i / around, 2 * np.pi * j / across
    r = thickness * (1 + bulge * np.sin(2 * u))
    vertices = np.stack([(1 + r * np.cos(v)) * np.cos(u), (1 + r * np.cos(v)) * np.sin(u), r * np.sin(v)], -1)
    i2, j2 = (i + 1) % around, (j + 1) % across
    faces = np.stack([i * across + j, i2 * across + j, i2 * across + j2, i * across + j2], -1)
    return vertices.reshape(-1, 3), faces.reshape(-1, 4)


def torus(name="Torus", **sizes):
    return mesh_object(name, *torus_arrays(**sizes))


def two_objects():
    """A torus and a ball with what an artist has on them: maps, slots of each kind, seams, attributes, properties."""
    for name, arrays in (("Torus", torus_arrays(around=8, across=5)), ("Ball", sphere_arrays(1))):
        mesh = mesh_object(name, *arrays).data
        for layer in ("First", "Second"):
            mesh.uv_layers.new(name=layer)
        mesh.uv_layers.active = mesh.uv_layers["Second"]
        mesh.edges[3].use_seam = True
        mesh.attributes.new("Height", "FLOAT_VECTOR", "POINT")
        mesh["mine"] = {"size": 3.5}
    torus, ball = bpy.data.objects["Torus"], bpy.data.objects["Ball"]
    for name in ("Of Mesh", "Covered"):
        torus.data.materials.append(bpy.data.materials.new(name))
    torus.material_slots[1].link = "OBJECT"
    torus.material_slots[1].material = bpy.data.materials.new("Of Object")
    torus.data.polygons[5].material_index = 1
    copy = torus.copy()  # shares the mesh
    bpy.context.scene.collection.objects.link(copy)
    select(torus, ball)
    return torus, ball


def two_parts(name, first, second):
    """One mesh object of two parts, each (vertices, faces)."""
    vertices = [*first[0], *(np.asarray(second[0]) + (0, 0, 3))]
    faces = [tuple(f) for f in first[1]] + [tuple(i + len(first[0]) for i in f) for f in second[1]]
    return mesh_object(name, vertices, faces)


def grid_arrays(count=6):
    """Quads of a square that is hardly bent: its map is even, and has no seams."""
    i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
    vertices = np.stack([i, j, 0.1 * i * j], -1).reshape(-1, 3).astype(float)
    a = (i * (count + 1) + j)[:-1, :-1].ravel()
    return vertices, np.stack([a, a + count + 1, a + count + 2, a + 1], -1)


def sphere_arrays(subdivisions=2):
    bm = bmesh.new()
    bmesh.ops.create_icosphere(bm, subdivisions=subdivisions, radius=0.5)
    bm.verts.index_update()
    vertices = [tuple(v.co) for v in bm.verts]
    faces = [tuple(v.index for v in f.verts) for f in bm.faces]
    bm.free()
    return vertices, faces


def limb_arrays():
    """A ball with a long limb: a log map of it is far from even."""
    vertices, faces = sphere_arrays(4)
    vertices = np.array(vertices)
    is_limb = vertices[:, 2] > 0.3
    vertices[is_limb, 2] += 6 * (vertices[is_limb, 2] - 0.3)
    return vertices, faces


def frame(name="Frame"):
    """A cuboctahedron's edges as a frame: genus 13."""
    bm = bmesh.new()
    bmesh.ops.create_cube(bm, size=2.0)
    bmesh.ops.bevel(bm, geom=bm.verts, offset=50.0, offset_type="PERCENT", affect="VERTICES", segments=1, profile=0.5)
    bmesh.ops.remove_doubles(bm, verts=bm.verts, dist=1e-4)
    bmesh.ops.wireframe(bm, faces=bm.faces, thickness=0.3, use_replace=True, use_even_offset=True)
    mesh = bpy.data.meshes.new(name)
    bm.to_mesh(mesh)
    bm.free()
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    select(obj)
    return obj


def run(main="BALANCED", **options):
    """The button, with the main map that most tests are about."""
    return bpy.ops.uv.holomorphic_maps(main=main, **options)


def then(**options):
    """What follows the solves of a `jobs.Job`: maps with these `options.MapOptions`."""
    library = {name: importlib.import_module(f"holomorph_addon.maps.{name}") for name in ("mapped", "options")}
    return partial(library["mapped"].mapped, options=library["options"].MapOptions(**options))


def written(obj, **options):
    """The `outcome.Outcome` of maps with these `options.MapOptions`."""
    names = ("scene.targets", "solving.jobs", "results.write", "writing.transaction")
    targets, jobs, write, transaction = (importlib.import_module(f"holomorph_addon.{name}") for name in names)
    found = targets.collect([obj])
    job = jobs.Job(targets.tasks(found), then=[then(**options)])
    job.run()
    with transaction.one_step(bpy.context, [obj]) as step:
        return write.write(step, found, job.results, write.WriteOptions())


def uv(obj, name="Holomorphic"):
    return uv_maps.read_map(obj.data, name).astype(np.float64)


def stored_poles(obj):
    """Vertices."""
    vertices, is_pole = stored.marks(obj["holomorph_report"])
    return vertices[is_pole].tolist()


def stored_report(obj):
    return json.loads(obj["holomorph_report"])


def polygon_arrays(mesh):
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    starts = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    return corners, np.append(starts, len(corners))


def next_corner(offsets):
    following = np.arange(1, offsets[-1] + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    return following


def shown_scale(obj):
    """The checker's squares per UV unit."""
    return obj.material_slots[0].material.node_tree.nodes["Checker Scale"].outputs[0].default_value


def edge_jumps(obj):
    """((n, 2) vertices of inner edges, (n, 2, 2) differences of the UVs of their two faces at each of these)."""
    corners, offsets = polygon_arrays(obj.data)
    following, values = next_corner(offsets), uv(obj)
    start, end = np.arange(len(corners)), following
    is_down = corners[start] > corners[end]
    ends = np.where(is_down[:, None], np.stack([end, start], 1), np.stack([start, end], 1))  # lower vertex first
    pairs = corners[ends].astype(np.int64)
    order = np.lexsort(pairs.T)
    same = np.flatnonzero((pairs[order][1:] == pairs[order][:-1]).all(axis=1))
    return pairs[order[same]], values[ends[order[same + 1]]] - values[ends[order[same]]]


def face_densities(obj):
    """(#F,) UV area per surface area, signed."""
    _, offsets = polygon_arrays(obj.data)
    values, following = uv(obj), next_corner(offsets)
    cross = values[:, 0] * values[following, 1] - values[following, 0] * values[:, 1]
    areas = np.empty(len(obj.data.polygons), np.float32)
    obj.data.polygons.foreach_get("area", areas)
    return np.add.reduceat(cross, offsets[:-1]) / 2 / areas


def signed_area(mesh, values):
    """Integral of du dv over the polygons, by the shoelace formula."""
    _, offsets = polygon_arrays(mesh)
    following = next_corner(offsets)
    return 0.5 * np.sum(values[:, 0] * values[following, 1] - values[following, 0] * values[:, 1])


def fills_the_square(values, density=1.0):
    """Whether the box of the UVs has its middle at that of the UV square and the square's size times `density`."""
    low, high = values.min(axis=0), values.max(axis=0)
    return np.allclose((low + high) / 2, 0.5, atol=1e-6) and abs((high - low).max() - density) < 1e-5 * density


def edge_mismatch(mesh, values):
    """Largest difference of the two UV vectors of an edge, over the median UV edge; and what float32 forgives."""
    corners, offsets = polygon_arrays(mesh)
    following = next_corner(offsets)
    start, end = corners, corners[following]
    vector = values[following] - values
    vector[start > end] *= -1
    key = np.minimum(start, end).astype(np.int64) * len(mesh.vertices) + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    assert np.array_equal(key[order][::2], key[order][1::2]), "a closed surface"
    difference = np.abs(vector[order][::2] - vector[order][1::2]).max()
    median = np.median(np.linalg.norm(vector, axis=1))
    forgiven = max(1e-4 * median, 4e-7 * np.ptp(values, axis=0).max())
    return difference, forgiven


def parts_of(obj):
    """The connected parts of an object as the library numbers them, with `corner_index` into its corners."""
    polygons = mesh_io.read_polygons(obj.data, np.eye(3))
    surface = polygons.surface()
    return surface.components


def boundary_corners(part):
    """(#, 2) polygon corners at the two ends of each boundary edge of a part."""
    following = next_corner(part.face_offsets)
    start, end = part.corner_vertices.astype(np.int64), part.corner_vertices[following].astype(np.int64)
    count = len(part.vertex_index)
    key = np.minimum(start, end) * count + np.maximum(start, end)
    _, place, uses = np.unique(key, return_inverse=True, return_counts=True)
    once = np.flatnonzero(uses[place] == 1)
    return np.stack([once, following[once]], 1)


def straightness(part, values):
    """The largest difference of v along a boundary edge; `values` are at the corners of the part."""
    v = values[boundary_corners(part), 1]
    return np.abs(v[:, 0] - v[:, 1]).max()


def tiled(obj, tiles=12, **options):
    """The object, with a seamless tiling without poles."""
    without = dict(poles="COUNT", pole_count=0, checker=False)
    assert bpy.ops.uv.holomorphic_tile(tiles=tiles, **without, **options) == {"FINISHED"}
    return obj


def everything(obj):
    """All that belongs to an artist's mesh object, for comparison bit for bit."""
    mesh = obj.data
    corners, offsets = polygon_arrays(mesh)
    positions = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", positions)
    edges = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", edges)
    return {
        "positions": positions.tobytes(),
        "corners": corners.tobytes(),
        "offsets": offsets.tobytes(),
        "edges": edges.tobytes(),
        "seams": mesh_io.read_seams(mesh).tobytes(),
        "maps": {layer.name: uv_maps.read_map(mesh, layer.name).tobytes() for layer in mesh.uv_layers},
        "attributes": sorted((a.name, a.domain, a.data_type) for a in mesh.attributes),
        "materials": [(s.link, s.material) for s in obj.material_slots],
        "properties": sorted(obj.keys()) + sorted(mesh.keys()),
    }


def linked(folder):
    """The one object of this file, linked from a file in the folder into a new one."""
    path = str(folder / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (source, target):
        target.objects = source.objects
    (obj,) = target.objects
    bpy.context.scene.collection.objects.link(obj)
    return obj


def moebius():
    count = 12
    angle = np.pi * np.arange(count) / count
    edge = np.stack([np.cos(angle), np.sin(angle), 0 * angle], -1)
    around = np.stack([np.cos(2 * angle), np.sin(2 * angle), 0 * angle], -1)
    side = around * edge[:, :1] * 0.3 + np.array([0, 0, 0.3]) * edge[:, 1:2]
    vertices = np.concatenate([around - side, around + side])
    faces = [(i, i + 1, count + i + 1, count + i) for i in range(count - 1)]
    faces.append((count - 1, count, 0, 2 * count - 1))
    return mesh_object("Bad", vertices, faces)


def duplicate(obj):
    """Linked: another object with the same mesh."""
    copy = obj.copy()
    bpy.context.scene.collection.objects.link(copy)
    return copy
