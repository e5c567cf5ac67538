"""Faces that are selected in edit mode, and an artist's own map beside ours."""

import bmesh
import bpy
import numpy as np
from loaded_addon import module
from scenes import mesh_io, select, uv_maps

ACROSS = 12  # faces across the torus of the scenes


def pick_faces(obj, wanted, hidden=()):
    """Edit mode with these faces selected, and some hidden."""
    if obj.mode != "EDIT":
        select(obj)
        bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_mode(type="FACE")
    bpy.ops.mesh.select_all(action="DESELECT")
    edited = bmesh.from_edit_mesh(obj.data)
    edited.faces.ensure_lookup_table()
    for index in hidden:
        edited.faces[index].hide_set(True)
    for index in wanted:
        edited.faces[index].select_set(True)
    bmesh.update_edit_mesh(obj.data)


def leave():
    bpy.ops.object.mode_set(mode="OBJECT")


def corners_of(faces):
    return (4 * np.asarray(faces)[:, None] + np.arange(4)).ravel()


def add_own_map(obj, name="Artist"):
    layer = obj.data.uv_layers.new(name=name)
    values = np.random.default_rng(1).random((len(obj.data.loops), 2))
    mesh_io.write_values(module("compatibility").uv_values(layer), values)
    return uv_maps.read_map(obj.data, name)


HALF = np.arange(12 * ACROSS)  # the faces of a bent pipe
