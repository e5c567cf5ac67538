"""The objects of the scene: making them, choosing them, and what the add-on has left on them."""

import json

import bmesh
import bpy
import numpy as np
from enabled import addon
from screen import area, hover, inside


def maps(name):
    return [layer.name for layer in bpy.data.objects[name].data.uv_layers]


def pick(name):
    bpy.context.view_layer.update()  # or it lists objects that are gone
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj.name == name)
    bpy.context.view_layer.objects.active = bpy.data.objects[name]


def look_at(name):
    """Alone, from the front and a little from above."""
    for obj in bpy.data.objects:
        obj.hide_set(obj.name != name)
    pick(name)
    with inside(area("VIEW_3D")):
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(angle=0.6, type="ORBITLEFT")
        bpy.ops.view3d.view_orbit(angle=0.4, type="ORBITUP")
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message=name)
    hover(area("VIEW_3D"))


def clear():
    """All objects are gone."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)


def pick_vertices(name, vertices):
    """Selects these vertices in edit mode, and no others."""
    mesh = bpy.data.objects[name].data
    edited = bmesh.from_edit_mesh(mesh)
    for face in edited.faces:
        face.select_set(False)
    for vertex in edited.verts:
        vertex.select_set(vertex.index in vertices)
    bmesh.update_edit_mesh(mesh)


def part_report(name):
    """What the report on the object says of its only part."""
    (part,) = json.loads(bpy.data.objects[name]["holomorph_report"])["components"]
    return part


def sheet(name, count, x):
    i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
    vertices = np.stack([x + i / count, j / count, 0.1 * (i / count) ** 2], -1).reshape(-1, 3)
    a = (i * (count + 1) + j)[:-1, :-1].ravel()
    corners = np.stack([a, a + count + 1, a + count + 2, a + 1], -1).ravel()
    add_object(name, vertices, corners)


def torus(name, around, across, x):
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    u, v = 2 * np.pi * i / around, 2 * np.pi * j / across
    radius = 1 + 0.4 * np.cos(v)
    vertices = np.stack([x + radius * np.cos(u), radius * np.sin(u), 0.4 * np.sin(v)], -1).reshape(-1, 3)
    i2, j2 = (i + 1) % around, (j + 1) % across
    corners = np.stack([i * across + j, i2 * across + j, i2 * across + j2, i * across + j2], -1).ravel()
    add_object(name, vertices, corners)


def add_object(name, vertices, corners):
    mesh_io = addon("scene.mesh_io")
    mesh = mesh_io.new_mesh(name, vertices, corners, np.arange(0, len(corners) + 1, 4))
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def spikes(name):
    """A ball with three spikes; the log map has its poles in two of them."""
    edited = bmesh.new()
    bmesh.ops.create_icosphere(edited, subdivisions=4, radius=0.5)
    for vertex in edited.verts:
        vertex.co *= 1 + 6 * np.exp(-24 * (0.5 - max(vertex.co)))
    mesh = bpy.data.meshes.new(name)
    edited.to_mesh(mesh)
    edited.free()
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def terrain(name, count=64):
    """Hills on a square of ten metres."""
    i, j = np.divmod(np.arange((count + 1) ** 2), count + 1)
    x, y = 10 * i / count, 10 * j / count
    waves = [(0.9, 0.3, 0.7), (-0.5, 1.1, 0.5), (1.9, 1.3, 0.25), (2.7, -2.1, 0.15), (-4.1, 3.3, 0.08)]
    z = sum(height * np.sin(a * x + b * y + k) for k, (a, b, height) in enumerate(waves))
    corner = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).ravel()
    corners = np.stack([corner, corner + count + 1, corner + count + 2, corner + 1], -1).ravel()
    add_object(name, np.stack([x, y, z], -1), corners)


def pipe(name, around=24, along=60):
    """A bent tube, open at both ends."""
    i, j = np.meshgrid(np.arange(along), np.arange(around), indexing="ij")
    bend, turn = 1.5 * np.pi * i / (along - 1), 2 * np.pi * j / around
    radius = 2 + 0.5 * np.cos(turn)
    vertices = np.stack([radius * np.cos(bend), 0.5 * np.sin(turn), radius * np.sin(bend)], -1).reshape(-1, 3)
    a = (i * around + j)[:-1]
    b = (i * around + (j + 1) % around)[:-1]
    add_object(name, vertices, np.stack([a, b, b + around, a + around], -1).ravel())


def figure(name):
    """A body of bones, edges alone, which a Skin modifier makes a surface of."""
    joints = [(0, 0, 1), (0, 0, 1.6), (0, 0, 2), (0.7, 0, 1.5), (-0.7, 0, 1.5), (0.3, 0, 0), (-0.3, 0, 0)]
    bones = [(0, 1), (1, 2), (1, 3), (1, 4), (0, 5), (0, 6)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(joints, bones, [])
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    pick(name)
    obj.modifiers.new("Skin", "SKIN")
    obj.modifiers.new("Subdivision", "SUBSURF").levels = 2
    mesh.skin_vertices[0].data[0].use_root = True
    for vertex in mesh.skin_vertices[0].data:
        vertex.radius = 0.2, 0.2
