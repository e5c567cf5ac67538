"""The objects of the scene: making them, choosing them, and what the add-on has left on them."""

import importlib
import json

import bmesh
import bpy
import numpy as np


def maps(name):
    return [layer.name for layer in bpy.data.objects[name].data.uv_layers]


def pick(name):
    bpy.context.view_layer.update()  # or it lists objects that are gone
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj.name == name)
    bpy.context.view_layer.objects.active = bpy.data.objects[name]


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
    mesh_io = importlib.import_module("holomorph_addon.mesh_io")
    mesh = mesh_io.new_mesh(name, vertices, corners, np.arange(0, len(corners) + 1, 4))
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def spikes(name):
    """A ball with three spikes; the log map has its punctures in two of them."""
    edited = bmesh.new()
    bmesh.ops.create_icosphere(edited, subdivisions=4, radius=0.5)
    for vertex in edited.verts:
        vertex.co *= 1 + 6 * np.exp(-24 * (0.5 - max(vertex.co)))
    mesh = bpy.data.meshes.new(name)
    edited.to_mesh(mesh)
    edited.free()
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))
