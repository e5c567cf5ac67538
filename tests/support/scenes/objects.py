"""Objects for the tests, and the operators that most tests call."""

import importlib
from functools import partial

import bmesh
import bpy
import numpy as np
from repository import ROOT


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
    """A torus and a ball with what an artist has on them: maps, slots of each kind, seams, attributes, properties; each
    in a collection of its own."""
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
    for name, objects in (("First", [torus]), ("Second", [ball, copy])):  # what is made for the torus is not the last
        collection = bpy.data.collections.new(name)
        bpy.context.scene.collection.children.link(collection)
        for obj in objects:
            collection.objects.link(obj)
            bpy.context.scene.collection.objects.unlink(obj)
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


def then(count=1, main="AUTOMATIC"):
    """What follows the solves of a `jobs.Job`: `mapped.MappedObject`s with this main map."""
    mapped = importlib.import_module("holomorph_addon.maps.mapped")
    return partial(mapped.follow, [mapped.MappedObject(mapped.Request(main.lower()), main=main)] * count, False)


def written(obj, **options):
    """The `write.Outcome` of maps as in `then`."""
    names = ("scene.targets", "solving.jobs", "results.write", "writing.transaction")
    targets, jobs, write, transaction = (importlib.import_module(f"holomorph_addon.{name}") for name in names)
    found = targets.collect([obj])
    job = jobs.Job(targets.tasks(found), then=then(**options))
    job.run()
    with transaction.one_step(bpy.context, [obj]) as step:
        return write.write(step, found, job.results, write.WriteOptions())


def tiled(obj, tiles=12, **options):
    """The object, with a seamless tiling without poles."""
    without = dict(poles="COUNT", pole_count=0, checker=False)
    assert bpy.ops.uv.holomorphic_tile(tiles=tiles, **without, **options) == {"FINISHED"}
    return obj


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
